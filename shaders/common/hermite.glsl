// Where a quantity passes zero inside a step.

// Root in 0…1 of the cubic Hermite polynomial with end values y0, y1 of opposite sign and slopes d0, d1 (per whole step): Newton from `t`.
float hermite_root_near(float t, float y0, float d0, float y1, float d1) {
    float c3 = 2.0 * (y0 - y1) + d0 + d1;
    float c2 = 3.0 * (y1 - y0) - 2.0 * d0 - d1;
    for (int i = 0; i < 3; ++i) {
        float y = y0 + t * (d0 + t * (c2 + t * c3));
        float slope = d0 + t * (2.0 * c2 + 3.0 * t * c3);
        t = clamp(t - y / (slope == 0.0 ? y0 - y1 : slope), 0.0, 1.0);
    }
    return t;
}

// The same from the secant: a step is short against an oscillation, so the cubic is nearly straight; the clamp is for the rest.
float hermite_root(float y0, float d0, float y1, float d1) {
    return hermite_root_near(y0 / (y0 - y1), y0, d0, y1, d1);
}
