// Slopes of rippled water, for any shader that draws it; RippleMap.use sets these uniforms.
uniform sampler2D ripple_map;
uniform vec4 ripple_place;  // middle of the water x, z, m; cos, sin of its heading
uniform vec4 ripple_scale;  // maps a metre, along and across; share of the later step; steepness

// Rise of the water along world x and z, m per m, blurred over so many metres.
vec2 ripple_slope(vec2 xz, float blur)
{
    vec2 d = xz - ripple_place.xy;
    vec2 own = vec2(d.x * ripple_place.z - d.y * ripple_place.w,
                    d.x * ripple_place.w + d.y * ripple_place.z);
    float texels = blur * ripple_scale.x * float(textureSize(ripple_map, 0).x);
    vec4 both = textureLod(ripple_map, own * ripple_scale.xy + 0.5, log2(max(texels, 1.0)));
    vec2 rise = (mix(both.xy, both.zw, ripple_scale.z) * (255.0 / 127.0) - 1.0) * ripple_scale.w;
    return vec2(rise.x * ripple_place.z + rise.y * ripple_place.w,
                rise.y * ripple_place.z - rise.x * ripple_place.w);
}
