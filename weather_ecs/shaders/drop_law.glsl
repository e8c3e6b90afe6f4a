// Laws of one drop. D: diameter in mm, v: speed in m/s, L: Marshall and Palmer's slope in 1/mm.
// law = (L, 1 - exp(-5.5 L), 0, 0).

// Inverse of the distribution of diameters in the air, between 0.5 and 6 mm.
float drop_diameter(float quantile, vec4 law)
{
    return min(0.5 - log(max(1.0 - quantile * law.y, 1e-7)) / law.x, 6.0);
}

// Terminal speed, the fit of Atlas et al. (1973).
float drop_speed(float diameter)
{
    return max(9.65 - 10.3 * exp(-0.6 * diameter), 0.0);
}
