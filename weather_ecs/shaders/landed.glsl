// A drop that has hit something keeps, where its velocity was, the place of the hit: it is not drawn,
// falls on as a mere place-holder, so that the filling of the container stays even, and begins anew
// at the top with the others. LANDED is added to the height, and tells a place from a velocity.
const float LANDED = 8192.0;
const float NO_IMPACT = 1e9;  // landed without having hit: it was under cover when it came in

bool has_landed(vec3 v)
{
    return v.y > 1024.0;
}
