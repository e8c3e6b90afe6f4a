// Quads of the splash's animated texture; see gpu/splash_texture.py for its layers.
const float FRAMES = 16.0;
const float CROWN = 0.0;
const float BURST = 2.0;
const float FILM = 4.0;
const float RING = 5.0;
const float BEAD = 96.0;
const float TALL = 0.75;   // half-height of an upright picture over its half-width
const float BELOW = 0.25;  // of its half-width lie below the hit

in vec3 vs_at[];
in vec3 vs_normal[];
in vec4 vs_color[];
in vec4 vs_form[];
out vec2 gs_uv;
flat out float gs_layer;
flat out vec4 gs_color;

// Layer of a kind at the share x of the splash's life.
float layer_at(float kind, float x)
{
    return kind * FRAMES + clamp(floor(x * FRAMES), 0.0, FRAMES - 1.0);
}

void corner(vec4 clip, vec2 uv, float layer, vec4 color)
{
    gl_Position = clip;
    gs_uv = uv;
    gs_layer = layer;
    gs_color = color;
    EmitVertex();
}

// About p, from p - a - b to p + a + b.
void quad(vec3 p, vec3 a, vec3 b, float layer, vec4 color)
{
    corner(lifted(p - a - b), vec2(0.0, 0.0), layer, color);
    corner(lifted(p + a - b), vec2(1.0, 0.0), layer, color);
    corner(lifted(p - a + b), vec2(0.0, 1.0), layer, color);
    corner(lifted(p + a + b), vec2(1.0, 1.0), layer, color);
    EndPrimitive();
}

// The same as one triangle, of which the fragment shader leaves out what lies beyond.
void triangle(vec3 p, vec3 a, vec3 b, float layer, vec4 color)
{
    corner(lifted(p - a - b), vec2(0.0, 0.0), layer, color);
    corner(lifted(p + 3.0 * a - b), vec2(2.0, 0.0), layer, color);
    corner(lifted(p - a + 3.0 * b), vec2(0.0, 2.0), layer, color);
    EndPrimitive();
}
