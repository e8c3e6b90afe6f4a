// A ray as an area's ellipse sees it, in shares of its radii: where it goes (x, y), minus its product
// with the place of the camera, and that with what is at right angles. Linear in the ray.
vec4 on_axes(int i, vec3 ray)
{
    vec4 turn = veil_turn[i];
    vec4 from = veil_from[i];
    vec2 own = vec2(dot(turn.xy, ray.xz), dot(turn.zw, ray.xz));
    return vec4(own, -dot(from.xy, own), from.x * own.y - from.y * own.x);
}
