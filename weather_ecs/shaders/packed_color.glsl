// A flat colour up to 3.9 and its opacity as two numbers, which stand beside what is not flat in one
// varying: Mesa's software rasteriser reads each from memory for every triangle, and sets it up.
vec2 pack_color(vec4 color)
{
    vec3 c = clamp(color.rgb, 0.0, 3.9);
    return floor(c.gb * 1000.0 + 0.5) + vec2(c.r * 0.25, min(color.a, 0.9999));
}

vec4 unpack_color(vec2 packed_color)
{
    vec2 whole = floor(packed_color);
    vec2 part = packed_color - whole;
    return vec4(part.x * 4.0, whole * 0.001, part.y);
}
