#ifdef MOTION
#include "motion.glsl"
in vec3 vs_motion;
out vec4 motion;

void main()
{
    motion = vec4(motion_bytes(vs_motion) / 255.0, 1.0);
}
#else
void main() {}
#endif
