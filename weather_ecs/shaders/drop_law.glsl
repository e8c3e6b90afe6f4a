// Laws of one drop. D: diameter in mm, v: speed in m/s, L: Marshall and Palmer's slope in 1/mm.
// law = (L, exp(-0.5 L), exp(-6 L), 0).

// Inverse of the distribution of diameters in the air, between 0.5 and 6 mm.
float drop_diameter(float quantile, vec4 law)
{
    return -log(law.y - quantile * (law.y - law.z)) / law.x;
}

// Terminal speed, the fit of Atlas et al. (1973).
float drop_speed(float diameter)
{
    return max(9.65 - 10.3 * exp(-0.6 * diameter), 0.0);
}
