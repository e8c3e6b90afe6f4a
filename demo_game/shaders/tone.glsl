// Scene light to display values, a film's curve (Hejl and Burgess-Dawson); gamma included.
vec3 tone(vec3 c) {
    c = max(c - 0.004, 0.0);
    return (c * (6.2 * c + 0.5)) / (c * (6.2 * c + 1.7) + 0.06);
}
