// Where light stands in the tone table: its leading bits say it. TONE_COLUMN_BITS and TONE_ROWS are the table's size (rendering/post.py).

const int TONE_FIRST_EXPONENT = -30; // row 0, which stands for all that is darker too; 48 rows lead to 2^17, and radiance is at most 6e4

ivec2 tone_table_place(float light) {
    int bits = floatBitsToInt(light) >> (23 - TONE_COLUMN_BITS);
    int row = (bits >> TONE_COLUMN_BITS) - (127 + TONE_FIRST_EXPONENT);
    return ivec2(bits & ((1 << TONE_COLUMN_BITS) - 1), clamp(row, 0, TONE_ROWS - 1));
}

// The light in the middle of an entry.
float tone_table_light(ivec2 place) {
    int bits = ((place.y + 127 + TONE_FIRST_EXPONENT) << TONE_COLUMN_BITS) + place.x;
    return intBitsToFloat((bits << (23 - TONE_COLUMN_BITS)) + (1 << (22 - TONE_COLUMN_BITS)));
}
