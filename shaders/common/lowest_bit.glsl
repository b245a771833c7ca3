// Sets of up to 24 things, a bit for each.

// The number of the lowest of `bits`, of which there is one: the exponent of a power of two. Mesa 22.3 makes another number of `bits & ~(bits - 1u)`.
int lowest_bit(uint bits) {
    return int(floatBitsToUint(float(bits ^ (bits & (bits - 1u)))) >> 23) - 127;
}

uint without_lowest(uint bits) {
    return bits & (bits - 1u);
}
