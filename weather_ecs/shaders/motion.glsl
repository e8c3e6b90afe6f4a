// Velocities of what rain hits, in bytes; gpu/heightmap.py has the texture, physics/ride.py is the
// oracle. Whoever is faster than FASTEST along an axis counts as standing still: it has been put there.
const float FASTEST = 16.0;  // m/s

vec3 motion_bytes(vec3 velocity)
{
    float most = max(abs(velocity.x), max(abs(velocity.y), abs(velocity.z)));
    return most < FASTEST ? floor(velocity * (127.0 / FASTEST) + 128.5) : vec3(128.0);
}

vec3 motion_velocity(vec3 bytes)
{
    return (bytes - 128.0) * (FASTEST / 127.0);
}

// The same three as one number that a float holds exactly, 0 of what stands still.
float packed_motion(vec3 bytes)
{
    return dot(bytes - 128.0, vec3(1.0, 256.0, 65536.0));
}

vec3 unpacked_motion(float number)
{
    vec3 high = floor((number + 8421504.0) / vec3(1.0, 256.0, 65536.0));
    return vec3(high.xy - 256.0 * high.yz, high.z);
}
