uniform sampler2D depth_map;
in vec2 v_uv;

void main() {
    gl_FragDepth = texelFetch(depth_map, ivec2(gl_FragCoord.xy), 0).r;
}
