// One billboard of a cloud; premultiplied, encoded.
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
// Here and not in uniforms, which a software driver fetches anew for every few pixels.
flat in vec4 vs_scene_at;  // place in the scene's depth: scale and offset of the pixel
flat in vec4 vs_guard;  // as cloud_guard; 1/m, over the depth at which it fades
flat in vec2 vs_depth;  // as cloud_depth

// 0 to 1: how far the scene is behind, over the depth at which the billboard fades.
float clearance()
{
    float depth = texture(scene_depth, gl_FragCoord.xy * vs_scene_at.xy + vs_scene_at.zw).r;
    if (depth >= 1.0 || depth < dot(vec3(gl_FragCoord.xy, 1.0), vs_guard.xyz)) return 1.0;
    float scene = vs_depth.y / (depth * 2.0 - 1.0 + vs_depth.x);
    float own = vs_depth.y / (gl_FragCoord.z * 2.0 - 1.0 + vs_depth.x);
    return clamp((scene - own) * vs_guard.w, 0.0, 1.0);
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
