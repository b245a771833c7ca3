// Numbers that everything shares. Lengths in r_s unless a name says M.

const int UNRESOLVED = 0;
const int ESCAPED = 1;
const int CAPTURED = 2;
const float PI = 3.14159265358979;
