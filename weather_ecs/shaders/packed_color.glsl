// A flat colour up to 3.9 and its opacity as two numbers, which stand beside what is not flat in one
// varying: Mesa's software rasteriser reads each from memory for every triangle, and sets it up. The
// parts keep away from whole numbers, as a driver may lose a little of what it interpolates.
const vec2 PART = vec2(0.24, 0.96);
const float ASIDE = 0.02;

vec2 pack_color(vec4 color)
{
    vec3 c = clamp(color.rgb, 0.0, 3.9);
    return floor(c.gb * 1000.0 + 0.5) + vec2(c.r, clamp(color.a, 0.0, 1.0)) * PART + ASIDE;
}

vec4 unpack_color(vec2 packed_color)
{
    vec2 whole = floor(packed_color);
    vec2 part = max(packed_color - whole - ASIDE, 0.0) / PART;
    return vec4(part.x, whole * 0.001, part.y);
}
