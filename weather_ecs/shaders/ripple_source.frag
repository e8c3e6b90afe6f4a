// A crater and its rim, that together hold no water more or less; as physics/ripple.add_sources.
in vec2 gs_off;
in float gs_depth;
out float added;

const float WIDTH = 1.25;

void main()
{
    float q = dot(gs_off, gs_off) / (2.0 * WIDTH * WIDTH);
    added = -gs_depth * (1.0 - q) * exp(-q);
}
