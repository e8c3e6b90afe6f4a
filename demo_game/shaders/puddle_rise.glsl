// mm of water that run off at p, (x, z), to where the ground is lower: broad and never the same
// again, so that the puddles of the tiled grain are not either.
float puddle_rise(vec2 p)
{
    vec2 q = p + 2.4 * sin(p.yx * vec2(0.23, 0.31));
    return 2.2 * sin(0.61 * q.x + 0.28 * q.y) * sin(0.52 * q.y - 0.17 * q.x);
}
