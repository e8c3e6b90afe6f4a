// Depth seen from the sun.
uniform mat4 light_matrix;

in vec3 in_position;

#ifdef TREES
in vec4 in_foot;
in vec4 in_turn;
#endif
#ifdef PARTS
in vec4 in_extra;
uniform mat4 parts[12];
#endif

void main() {
    vec3 p = in_position;
#ifdef TREES
    p *= in_foot.w;
    p.xz = mat2(in_turn.x, -in_turn.y, in_turn.y, in_turn.x) * p.xz;
    p += in_foot.xyz;
#endif
#ifdef PARTS
    p = (parts[int(in_extra.y * 255.0 + 0.5)] * vec4(p, 1.0)).xyz;
#endif
    gl_Position = light_matrix * vec4(p, 1.0);
}
