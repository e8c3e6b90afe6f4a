// Rain that begins and ends; physics/front.py is the oracle, symbol for symbol. dry: (from, to, from,
// to), the fall times in s of the drops that are missing. L: slope of the diameters in 1/mm.

const vec4 SETTLED = vec4(0.0);

// 1 where a drop is there that left the ceiling so many seconds ago, 0 where it is missing.
float fallen_share(float fall_time, vec4 dry)
{
    vec4 past = clamp((fall_time - dry) * 2.0 + 0.5, 0.0, 1.0);
    return clamp(1.0 - (past.x - past.y) - (past.z - past.w), 0.0, 1.0);
}

// Integral of x^k exp(-decay (x - 0.5)) from x = 0.5 to d.
float drop_moment(int k, float decay, float d)
{
    float end = exp(-decay * (d - 0.5));
    float integral = (1.0 - end) / decay;
    float low = 1.0;
    float high = 1.0;
    for (int power = 1; power <= k; ++power) {
        low *= 0.5;
        high *= d;
        integral = (low - high * end + float(power) * integral) / decay;
    }
    return integral;
}

float diameter_at(float speed)
{
    return clamp(log(10.3 / max(9.65 - speed, 1e-6)) / 0.6, 0.5, 6.0);
}

// Share of the extinction that drops slower than `speed` are the cause of.
float extinction_below(float speed, float L)
{
    return drop_moment(2, L, diameter_at(speed)) / drop_moment(2, L, 6.0);
}

float water_carried(float d, float L)
{
    return 9.65 * drop_moment(3, L, d) - 7.630428 * drop_moment(3, L + 0.6, d);
}

// Share of the water crossing a level plane that drops slower than `speed` carry.
float water_below(float speed, float L)
{
    return water_carried(diameter_at(speed), L) / water_carried(6.0, L);
}

// Speeds between which the drops of one spell are missing, `fall` m below the ceiling.
vec2 missing_speeds(float fall, vec2 spell)
{
    float way = max(fall, 1e-3);
    return vec2(way / max(spell.y, 1e-9), spell.x > 0.0 ? way / max(spell.x, 1e-9) : 20.0);
}

float extinction_arrived(float fall, vec4 dry, float L)
{
    float share = 1.0;
    for (int k = 0; k < 2; ++k) {
        vec2 spell = k == 0 ? dry.xy : dry.zw;
        if (spell.y <= spell.x) continue;
        vec2 v = missing_speeds(fall, spell);
        share -= extinction_below(v.y, L) - extinction_below(v.x, L);
    }
    return clamp(share, 0.0, 1.0);
}

float water_arrived(float fall, vec4 dry, float L)
{
    float share = 1.0;
    for (int k = 0; k < 2; ++k) {
        vec2 spell = k == 0 ? dry.xy : dry.zw;
        if (spell.y <= spell.x) continue;
        vec2 v = missing_speeds(fall, spell);
        share -= water_below(v.y, L) - water_below(v.x, L);
    }
    return clamp(share, 0.0, 1.0);
}
