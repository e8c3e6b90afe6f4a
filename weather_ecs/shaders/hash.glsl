// Integer hash of two words (the PCG output permutation); the same as physics/rain_step.py.
uint hash_word(uint x)
{
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// In [0, 1): 24 bits, exact in a float.
float hash_unit(uint x)
{
    return float(hash_word(x) >> 8u) * (1.0 / 16777216.0);
}
