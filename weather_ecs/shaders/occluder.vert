// An occluder seen along the rain's fall, for its depth alone.
uniform mat4 to_map;  // mesh to clip space of the map

in vec3 in_vertex;

void main()
{
    gl_Position = to_map * vec4(in_vertex, 1.0);
    // What stands above the map's top still keeps the rain off.
    gl_Position.z = max(gl_Position.z, -gl_Position.w);
}
