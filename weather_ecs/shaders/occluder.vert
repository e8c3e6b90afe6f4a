// Occluders of one mesh seen along the rain's fall, for their depth alone, or for their MOTION too.
in vec3 in_vertex;
in mat4 in_to_map;  // of the instance: mesh to clip space of the map

#ifdef MOTION
in vec4 in_x;  // rows: a point of the mesh to m/s
in vec4 in_y;
in vec4 in_z;
out vec3 vs_motion;
#endif

void main()
{
#ifdef MOTION
    vec4 at = vec4(in_vertex, 1.0);
    vs_motion = vec3(dot(in_x, at), dot(in_y, at), dot(in_z, at));
#endif
    gl_Position = in_to_map * vec4(in_vertex, 1.0);
    // What stands above the map's top still keeps the rain off.
    gl_Position.z = max(gl_Position.z, -gl_Position.w);
}
