// One billboard of a cloud; premultiplied, encoded.
#include <block:CloudView>

uniform sampler2DArray cloud_images;

in vec3 vs_uv;
in vec3 vs_lit;
in vec3 vs_shade;
in vec3 vs_rim;
in vec3 vs_relief;
in vec4 vs_fade;
flat in vec4 vs_haze;
out vec4 color;

#ifdef SOFT
uniform sampler2D scene_depth;
uniform vec4 cloud_scene_at;  // the scene's texel: scale and offset of the pixel
uniform vec3 cloud_guard;  // depth by pixel's x, by y, at 0: what is nearer hides all of the clouds

// 0 to 1: how far the scene is behind, over the depth at which the billboard fades.
float clearance()
{
    ivec2 texel = ivec2(gl_FragCoord.xy * cloud_scene_at.xy + cloud_scene_at.zw);
    float depth = texelFetch(scene_depth, min(texel, textureSize(scene_depth, 0) - 1), 0).r;
    if (depth >= 1.0 || depth < dot(vec3(gl_FragCoord.xy, 1.0), cloud_guard)) return 1.0;
    float scene = cloud_depth.y / (depth * 2.0 - 1.0 + cloud_depth.x);
    float own = cloud_depth.y / (gl_FragCoord.z * 2.0 - 1.0 + cloud_depth.x);
    return clamp((scene - own) / max(vs_fade.z * cloud_softness, 1e-3), 0.0, 1.0);
}
#endif

void main()
{
    vec4 texel = texture(cloud_images, vs_uv);
    float alpha = texel.a * (1.0 - vs_relief.z * (1.0 - texel.a)) * vs_fade.x * clamp(vs_fade.y, 0.0, 1.0);
#ifdef SOFT
    alpha *= clearance();
#endif
    vec2 slope = texel.rg * 2.0 - 1.0;
    float facing = clamp(vs_fade.w + dot(slope, vs_relief.xy), 0.0, 1.0);
    vec3 light = mix(vs_shade, vs_lit, facing) * texel.b + vs_rim * (1.0 - texel.a * texel.a);
    color = vec4(mix(light, vs_haze.rgb, vs_haze.w) * alpha, alpha);
}
