// The box of one seed as twelve lines, and the ray from its centre to the light.
#include "cloud_row.glsl"

uniform mat4 cloud_matrix;
uniform ivec2 ray_cloud;  // row of the cloud, its first seed
uniform vec4 ray_light;  // unit, in the shape's axes; m, length of the ray

out vec3 vs_color;

void main()
{
    Cloud cloud = fetch_cloud(ray_cloud.x);
    vec3 size;
    vec4 seed = fetch_seed(ray_cloud.y + gl_InstanceID, cloud.fresh, size);
    vec3 p;
    if (gl_VertexID < 24) {
        int edge = gl_VertexID >> 1;
        int axis = edge >> 2;
        vec3 c;
        c[axis] = float(gl_VertexID & 1) - 0.5;
        c[(axis + 1) % 3] = float(edge & 1) - 0.5;
        c[(axis + 2) % 3] = float((edge >> 1) & 1) - 0.5;
        p = seed.xyz + c * size;
        vs_color = mix(vec3(0.95, 0.95, 1.0), vec3(0.15, 0.18, 0.35), seed.w);
    } else {
        p = seed.xyz + ray_light.xyz * (ray_light.w * float(gl_VertexID & 1));
        vs_color = mix(vec3(1.0, 0.9, 0.1), vec3(1.0, 0.1, 0.05), seed.w);
    }
    gl_Position = cloud_matrix * vec4(cloud.center + place_in_cloud(cloud, p), 1.0);
    gl_Position.z = min(gl_Position.z, 0.999999 * gl_Position.w);
}
