// A step of PCG's output (O'Neill 2014), and the number in [0, 1) of a word.
uint hash_word(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

float hash_unit(uint x) {
    return float(hash_word(x) >> 8u) / 16777216.0;
}
