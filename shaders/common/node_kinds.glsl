// What holds of a node of the coarse grid and its four neighbours, in 32 bits.
//
//   bits 0–1                    fate of all five; UNRESOLVED where they differ
//   bits 2, 3                   NODE_DIRECTION_BENDS, NODE_DIRECTION_CURVES
//   bits 4–11, 12–19, 20–27     of crossing 0, 1, 2: the flags below, which hold where they hold for some of the five
//   bits 28–29, 30–31           of crossing 0, 1: NODE_OUTBOUND, NODE_INBOUND, likewise

const uint NODE_DIRECTION_BENDS = 4u;     // too much to be interpolated within the tolerance
const uint NODE_DIRECTION_CURVES = 8u;    // too much to be interpolated linearly: not flat

const uint NODE_MISSES = 1u;              // there is none
const uint NODE_CROSSES = 2u;
const uint NODE_BELOW_OUTER_MARGIN = 4u;  // on the near side of the radius beyond which crossings do not matter, or between points that are
const uint NODE_BELOW_OUTER_EDGE = 8u;
const uint NODE_ABOVE_INNER_MARGIN = 16u;
const uint NODE_ABOVE_INNER_EDGE = 32u;
const uint NODE_BEFORE_DISK = 64u;        // not within the inner margin, and before the disk's far side as the camera sees it
const uint NODE_BENDS = 128u;             // as directions

const uint NODE_OUTBOUND = 1u;            // the light goes away from the hole
const uint NODE_INBOUND = 2u;             // it still comes in

#define NODE_CROSSING_BITS(n) (4 + 8 * (n))
#define NODE_SENSE_BITS(n) (28 + 2 * (n))

bool has_all(uint kinds, uint flags) {
    return (kinds & flags) == flags;
}
