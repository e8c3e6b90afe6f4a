// Snow that lies; physics/snow_cover.py, symbol for symbol. S: mm of water, s: mm/s that reach it and
// stay, m: mm/s that melt.
float collect(float S, float s, float m, float seconds)
{
    return max(S + (s - m) * seconds, 0.0);
}

// Share of the snow that stays on a surface whose normal points up by `up`.
float snow_stays(float up)
{
    return smoothstep(0.5, 0.8, up);
}
