// A container's own axes: axis = (centre x, centre z, cos heading, sin heading),
// shape = (forward reach, lateral reach, bottom, height). q = (forward, lateral) in shares of reach.
vec2 to_container(vec2 p, vec4 axis, vec2 reach)
{
    vec2 e = p - axis.xy;
    return vec2(e.x * axis.z - e.y * axis.w, e.x * axis.w + e.y * axis.z) / reach;
}

vec2 from_container(vec2 q, vec4 axis, vec2 reach)
{
    vec2 e = q * reach;
    return axis.xy + vec2(e.x * axis.z + e.y * axis.w, -e.x * axis.w + e.y * axis.z);
}

vec2 turn_to_container(vec2 v, vec4 axis, vec2 reach)
{
    return vec2(v.x * axis.z - v.y * axis.w, v.x * axis.w + v.y * axis.z) / reach;
}

bool in_half_disc(vec2 q, float s)
{
    return q.x >= 0.0 && dot(q, q) <= s * s;
}

// Even in the half disc of radius s.
vec2 half_disc_point(float s, float u0, float u1)
{
    float r = s * sqrt(u0);
    float angle = (u1 - 0.5) * 3.14159265358979;
    return r * vec2(cos(angle), sin(angle));
}
