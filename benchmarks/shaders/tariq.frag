// Opacity from the library of appearances, blended between the four nearest, for each light.
uniform sampler2DArray library;
uniform vec3 sun_color;
uniform float opacity;
#ifdef LAMP
uniform vec4 lamp_color;  // and its strength
#endif

in vec2 gs_uv;
flat in vec4 gs_layers;
flat in vec4 gs_blend;
#ifdef LAMP
flat in vec4 gs_lamp_layers;
flat in vec4 gs_lamp_blend;
#endif
out vec4 color;

float response(vec4 layers, vec4 blend)
{
    vec2 uv = vec2(abs(blend.z - gs_uv.x), gs_uv.y);
    float a = texture(library, vec3(uv, layers.x)).r;
    float b = texture(library, vec3(uv, layers.y)).r;
    float c = texture(library, vec3(uv, layers.z)).r;
    float d = texture(library, vec3(uv, layers.w)).r;
    return mix(mix(a, b, blend.y), mix(c, d, blend.y), blend.x) * blend.w;
}

void main()
{
    float sun = opacity * response(gs_layers, gs_blend);
#ifdef LAMP
    float lamp = lamp_color.a * response(gs_lamp_layers, gs_lamp_blend);
    float both = sun + lamp;
    color = vec4((sun_color * sun + lamp_color.rgb * lamp) / max(both, 1e-4), both);
#else
    color = vec4(sun_color, sun);
#endif
}
