// What of a flash in the clouds arrives; physics/cloud_light.near_flash.
// at: its place from the camera, m; w 1/m2, of its core. p: place from the camera. 0 to 1.
float flash_share(vec4 at, vec3 p)
{
    vec3 way = p - at.xyz;
    float u = 1.0 + dot(way, way) * at.w;
    return inversesqrt(u * u * u);
}
