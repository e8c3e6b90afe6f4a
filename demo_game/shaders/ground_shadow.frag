// Shadows of what stands still, laid on the ground's painted map (its alpha).
uniform sampler2D height_map;
uniform sampler2DShadow shadow_map;
uniform mat4 shadow_matrix;
uniform vec4 map_window;   // low corner x, z, 1 / size x, z

in vec2 v_uv;
out vec4 out_color;

void main() {
    vec2 place = map_window.xy + v_uv / map_window.zw;
    vec3 p = vec3(place.x, texture(height_map, v_uv).r + 0.05, place.y);
    vec3 at = (shadow_matrix * vec4(p, 1.0)).xyz;
    float step = 0.75 / float(textureSize(shadow_map, 0).x);
    float lit = 0.0;
    for (int i = -1; i <= 1; i++) {
        for (int j = -1; j <= 1; j++) {
            lit += texture(shadow_map, at + vec3(float(i) * step, float(j) * step, 0.0));
        }
    }
    out_color = vec4(0.0, 0.0, 0.0, lit / 9.0);
}
