// The sheet of veils, coarser than the picture, over it; premultiplied.
#include "grain.glsl"

uniform sampler2D veil_sheet;

noperspective in vec3 vs_ray;
noperspective in vec2 vs_place;
out vec4 color;

void main()
{
    color = texture(veil_sheet, vs_place);
    color.rgb += pixel_grain() * min(color.a * 20.0, 1.0);
}
