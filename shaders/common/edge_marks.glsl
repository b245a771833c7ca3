// What edge_marks.frag leaves for edge_pixels.frag, two numbers of eight bits: the fate with the zones of the rings, and what is met. 255 is no ray.

const int RING_1 = 4;     // two bits
const int RING_2 = 16;    // two bits, of which the first is the disk's
const int VEILED = 64;
const int NO_RAY = 255;
