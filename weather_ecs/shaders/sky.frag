noperspective in vec3 vs_color;
out vec4 color;

void main()
{
    // A step of noise hides the steps of 8 bits: Roberts' R2 sequence, which costs least.
    float noise = fract(dot(gl_FragCoord.xy, vec2(0.7548776662, 0.5698402910)));
    color = vec4(vs_color + (noise * (1.0 / 255.0) - 0.5 / 255.0), 1.0);
}
