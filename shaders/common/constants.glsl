// Numbers that everything shares. Lengths in r_s unless a name says M.
// What became of a ray (UNRESOLVED, ESCAPED, CAPTURED) and what a pixel needs (PIXEL_…) are #defines, made with the host's own: glsl/declared.py.

// The depth of pixels of a class.
float class_depth(int pixel_class) {
    return 0.1 * float(pixel_class) + 0.05;
}
