// Looks at the bits: compilers take liberties with comparisons of what is no number, Mesa's among them.
bool is_finite(vec3 v) {
    return all(notEqual(floatBitsToUint(v) & uvec3(0x7f800000u), uvec3(0x7f800000u)));
}
