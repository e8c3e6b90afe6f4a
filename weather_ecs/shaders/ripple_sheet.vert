// A water surface as a level grid of SIDE x SIDE squares; no vertex data.
#include <block:RainView>
#include <block:RippleSheet>
#include "rain_area.glsl"

const int SIDE = 12;

out vec3 vs_ray;   // m, from the camera
out vec2 vs_own;    // m, own axes
out vec2 vs_rain;   // share of the full rain; slope that it gives the water

void main()
{
    int square = gl_VertexID / 6;
    int corner = gl_VertexID % 6;
    ivec2 at = ivec2(square % SIDE, square / SIDE)
        + ivec2(corner == 1 || corner == 3 || corner == 4, corner == 2 || corner >= 4);
    vs_own = (vec2(at) * (2.0 / float(SIDE)) - 1.0) * sheet_body.xy;
    vec2 xz = sheet_frame.xy + vec2(vs_own.x * sheet_frame.z + vs_own.y * sheet_frame.w,
                                    vs_own.y * sheet_frame.z - vs_own.x * sheet_frame.w);
    vec3 place = vec3(xz.x, sheet_body.z, xz.y);
    vs_ray = place - camera_position.xyz;
    vs_rain = vec2(0.0);
    for (int i = 0; i < sheet_areas; ++i) {
        float share = area_factor(xz, sheet_area_axis[i], sheet_area_shape[i]);
        vs_rain += share * vec2(1.0, sheet_area_rough[i].x);
    }
    gl_Position = view_projection * vec4(place, 1.0);
}
