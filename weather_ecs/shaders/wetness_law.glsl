// Water on a surface; physics/wetness.py, symbol for symbol. w: mm that lie there, s: mm/s that reach
// it, c: mm that it holds before water runs off it.
//   dw/dt = s - w / DRYING - max(w - c, 0) / DRAINING
const float DRYING = 180.0;   // s
const float DRAINING = 15.0;  // s
const float FILM = 1.0;       // mm that level ground holds
const float STEEP_FILM = 0.3;
const float CATCHMENT = 8.0;  // times its own rain that runs together in a hollow
const float DEEPEST = 60.0;   // mm
const float FAST = 1.0 / DRYING + 1.0 / DRAINING;

float film_capacity(float up)
{
    return mix(STEEP_FILM, FILM, smoothstep(0.5, 0.95, up));
}

float settle(float w, float s, float c, float seconds)
{
    float low = s * DRYING;
    float high = (s + c / DRAINING) / FAST;
    if (w <= c) {
        float below = low + (w - low) * exp(-seconds / DRYING);
        if (below <= c) return below;
        float left = seconds - DRYING * log((low - w) / (low - c));
        return high + (c - high) * exp(-max(left, 0.0) * FAST);
    }
    float above = high + (w - high) * exp(-seconds * FAST);
    if (above >= c) return above;
    float left = seconds - log((w - high) / (c - high)) / FAST;
    return low + (c - low) * exp(-max(left, 0.0) / DRYING);
}
