// Adds up: mm/h m2 caught, m2 watched, share of the opening that is open, and what
// is caught once more, by the drops' own water.
flat in vec4 vs_sum;
out vec4 sum;

void main()
{
    sum = vs_sum;
}
