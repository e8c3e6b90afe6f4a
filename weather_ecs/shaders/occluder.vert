// Occluders of one mesh seen along the rain's fall, for their depth alone.
in vec3 in_vertex;
in mat4 in_to_map;  // of the instance: mesh to clip space of the map

void main()
{
    gl_Position = in_to_map * vec4(in_vertex, 1.0);
    // What stands above the map's top still keeps the rain off.
    gl_Position.z = max(gl_Position.z, -gl_Position.w);
}
