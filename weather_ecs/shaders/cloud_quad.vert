// Impostors: pictures of whole clouds, each on the plane it was taken on; octagons, as what is empty
// costs as much as the rest.
uniform sampler2D cloud_quads;  // nine texels each
uniform int cloud_first;
uniform mat4 cloud_matrix;

#ifndef FADING
out vec2 vs_uv;
#endif
flat out vec4 vs_haze;
flat out vec2 vs_share;
#ifdef FADING
out vec2 vs_now;  // place in the newer picture, which may end before this octagon does
flat out vec3 vs_tile;  // its frame
out vec2 vs_before;  // place in the older picture
flat out vec4 vs_frame;  // the older picture's frame
#endif
#ifdef FLASHES
#include "cloud_flash.glsl"
out vec3 vs_from;  // place from the camera, m
// Of the flash that counts most here: a pixel works it out for itself. Of others the corners tell.
flat out vec4 vs_flash_at;
flat out vec3 vs_flash_color;
out vec3 vs_others;
#endif

void main()
{
    int row = cloud_first + gl_InstanceID;
    vec4 a = texelFetch(cloud_quads, ivec2(0, row), 0);  // centre, opacity
    vec4 b = texelFetch(cloud_quads, ivec2(1, row), 0);  // half of the width, share of the newer
    vec4 c = texelFetch(cloud_quads, ivec2(2, row), 0);  // half of the height, flash
    vec4 uv = texelFetch(cloud_quads, ivec2(3, row), 0);  // corner and size; of the octagon
    vs_haze = texelFetch(cloud_quads, ivec2(4, row), 0);
    vs_haze.rgb *= vs_haze.w;
    vs_share = vec2(a.w, b.w);
    // Strip of an octagon: 0 1 7 2 6 3 5 4; two of its corners for each of the rectangle's.
    int side = (gl_VertexID & 1) == 1 ? (gl_VertexID + 1) >> 1 : (8 - (gl_VertexID >> 1)) & 7;
    int quarter = side >> 1;
    float cut = texelFetch(cloud_quads, ivec2(8, row), 0)[quarter] - 1.0;
    vec2 corner = ((side ^ quarter) & 1) == 0 ? vec2(1.0, cut) : vec2(cut, 1.0);
    corner *= vec2(quarter == 0 || quarter == 3 ? 1.0 : -1.0, quarter < 2 ? 1.0 : -1.0);
#ifdef FADING
    corner *= uv.w;
#endif
    vec3 p = a.xyz + b.xyz * corner.x + c.xyz * corner.y;
#ifdef FLASHES
    vs_from = p;
    int most = brightest_flash(a.xyz);
    vs_flash_at = most < 0 ? vec4(0.0, 0.0, 0.0, 1.0) : cloud_flash_at[most];
    vs_flash_color = most < 0 ? vec3(0.0) : cloud_flash_color[most].rgb;
    vs_others = flashes_but(most, p) + own_flash(c.w, vec3(0.7));
#endif
#ifndef FADING
    vs_uv = uv.xy + uv.z * (corner * 0.5 + 0.5);
#else
    vs_now = corner * 0.5 + 0.5;
    vs_tile = uv.xyz;
    vs_before = vec2(0.0);
    vs_frame = vec4(0.0);
    if (b.w < 1.0) {
        // Where the line of sight to this corner meets the older picture's plane.
        vec4 d = texelFetch(cloud_quads, ivec2(5, row), 0);
        vec4 e = texelFetch(cloud_quads, ivec2(6, row), 0);
        vec4 f = texelFetch(cloud_quads, ivec2(7, row), 0);
        vec3 n = cross(e.xyz, f.xyz);
        float depth = dot(p, n) / dot(d.xyz, n);
        vec3 on = p / depth - d.xyz;
        vec2 at = vec2(dot(on, e.xyz) / dot(e.xyz, e.xyz), dot(on, f.xyz) / dot(f.xyz, f.xyz));
        vs_before = at * 0.5 + 0.5;
        vs_frame = vec4(d.w, e.w, f.w, f.w);
    }
#endif
    gl_Position = cloud_matrix * vec4(p, 1.0);
    gl_Position.z = min(gl_Position.z, 0.999999 * gl_Position.w);
}
