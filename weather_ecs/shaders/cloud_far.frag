// For a canvas, the depth of what of the scene is beyond its guard; what is nearer hides the canvas
// itself, with the picture's own pixels.
uniform sampler2D scene_depth;

in vec2 vs_at;
in float vs_guard;
flat in vec2 vs_reach;
out vec4 color;

void main()
{
    float depth = textureLod(scene_depth, vs_at, 0.0).r;
    if (depth < vs_guard) depth = 1.0;
    // Shown, a pixel of the canvas reaches so far: nothing of it may be missing there. A software
    // driver works off a branch that it does not take, but not the turns of a loop.
    int looks = depth < 1.0 ? 9 : 0;
    for (int k = 0; k < looks; ++k) {
        vec2 beside = vs_at + vs_reach * (vec2(k % 3, k / 3) - 1.0);
        depth = max(depth, textureLod(scene_depth, beside, 0.0).r);
    }
    gl_FragDepth = depth;
    color = vec4(0.0);
}
