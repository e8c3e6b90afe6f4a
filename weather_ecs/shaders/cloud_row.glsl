// What the drawing of clouds reads from textures: one row a cloud, and the shapes' seeds and
// billboards. Positions are relative to the camera, world axes, m; a shape's own are about its
// centre, before scale, mirror, heading and shear.
uniform sampler2D cloud_rows;
uniform sampler2D cloud_billboards;
uniform sampler2D cloud_seeds;

struct Cloud {
    vec3 center;
    float opacity;
    vec2 turn;  // cosine and sine of the heading
    float scale;
    float mirror;
    vec2 shear;
    float growth;
    float mode;
    float darkness;
    float flash;
    float fresh;  // share of the newer of the absorptions
    vec2 shaded;  // what other clouds take of the sun's light and of the sky's
    float thick;  // 1/m, what a way through it adds to what is absorbed
    vec3 half_size;  // m, of the box that holds the billboards, scaled
    float base;  // m, of the cloud's underside, from its centre
    vec3 haze;  // encoded
    float fog;  // share of the haze
};

struct Billboard {
    vec3 position;
    float turn;
    vec2 size;
    float image;
    int seed;
    float order;
    float opacity;
};

Cloud fetch_cloud(int row)
{
    vec4 a = texelFetch(cloud_rows, ivec2(0, row), 0);
    vec4 b = texelFetch(cloud_rows, ivec2(1, row), 0);
    vec4 c = texelFetch(cloud_rows, ivec2(2, row), 0);
    vec4 d = texelFetch(cloud_rows, ivec2(3, row), 0);
    vec4 e = texelFetch(cloud_rows, ivec2(4, row), 0);
    vec4 f = texelFetch(cloud_rows, ivec2(5, row), 0);
    vec2 shaded = vec2(floor(b.w) / 255.0, fract(b.w));
    return Cloud(a.xyz, a.w, b.xy, abs(b.z), sign(b.z), c.xy, c.z, c.w, d.x, d.y, d.z, shaded, d.w, e.xyz,
                 e.w, f.xyz, f.w);
}

Billboard fetch_billboard(int index)
{
    ivec2 at = ivec2(6 * (index & 255), index >> 8);
    vec4 a = texelFetch(cloud_billboards, at, 0);
    vec4 b = texelFetch(cloud_billboards, at + ivec2(1, 0), 0);
    vec4 c = texelFetch(cloud_billboards, at + ivec2(2, 0), 0);
    return Billboard(a.xyz, a.w, b.xy, b.z, int(b.w), c.x, c.y);
}

// Centre of a seed, and its absorption now.
vec4 fetch_seed(int index, float fresh, out vec3 size)
{
    ivec2 at = ivec2(2 * (index & 255), index >> 8);
    vec4 a = texelFetch(cloud_seeds, at, 0);
    vec4 b = texelFetch(cloud_seeds, at + ivec2(1, 0), 0);
    size = b.xyz;
    return vec4(a.xyz, mix(a.w, b.w, fresh));
}

// Where the seeds about a billboard are, and what is absorbed at an offset from its middle, both in
// the shape's own axes.
vec4 fetch_light(int index, float fresh, vec3 offset)
{
    ivec2 at = ivec2(6 * (index & 255), index >> 8);
    vec3 center = texelFetch(cloud_billboards, at + ivec2(3, 0), 0).xyz;
    vec4 a = texelFetch(cloud_billboards, at + ivec2(4, 0), 0);
    vec4 b = texelFetch(cloud_billboards, at + ivec2(5, 0), 0);
    vec4 field = mix(a, b, fresh);
    return vec4(center, clamp(field.x + dot(field.yzw, offset), 0.0, 1.0));
}

// An offset in the cloud, in the shape's own axes; shear left aside.
vec3 to_shape(Cloud cloud, vec3 v)
{
    v.xz = vec2(v.x * cloud.turn.x - v.z * cloud.turn.y, v.z * cloud.turn.x + v.x * cloud.turn.y);
    v.x *= cloud.mirror;
    return v / cloud.scale;
}

// A place of the shape in the cloud, from the cloud's centre; as physics/cloud_billboard.place.
vec3 place_in_cloud(Cloud cloud, vec3 p)
{
    p *= cloud.scale;
    p.x *= cloud.mirror;
    p.xz = vec2(p.x * cloud.turn.x + p.z * cloud.turn.y, p.z * cloud.turn.x - p.x * cloud.turn.y);
    p.xz += cloud.shear * p.y;
    return p;
}

// 0 to 1: how much of a billboard is there; as physics/cloud_billboard.presence.
float presence(Cloud cloud, float order)
{
    float turn = mix(order, 1.0 - order, cloud.mode);
    return smoothstep(0.0, 1.0, (cloud.growth * 1.3 - turn) / 0.3);
}
