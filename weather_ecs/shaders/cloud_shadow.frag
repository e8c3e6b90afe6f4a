// What one billboard takes of the sun; blended by multiplication, so that order does not matter.
uniform sampler2DArray cloud_images;

in vec3 vs_uv;
flat in float vs_opacity;
out vec4 color;

void main()
{
    color = vec4(0.0, 0.0, 0.0, 0.72 * texture(cloud_images, vs_uv).a * vs_opacity);
}
