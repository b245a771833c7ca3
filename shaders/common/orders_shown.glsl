// Which crossings of the disk are shown: all of them, one order alone, or each in a colour of its own (disk.orders_shown).

#if DISK_ORDERS_SHOWN_DIRECT
#define ONLY_ORDER 0
#elif DISK_ORDERS_SHOWN_FIRST_RING
#define ONLY_ORDER 1
#elif DISK_ORDERS_SHOWN_SECOND_RING
#define ONLY_ORDER 2
#else
#define ONLY_ORDER -1
#endif

Hits shown_orders(Hits hits) {
#if ONLY_ORDER >= 0
    for (int n = 0; n < 3; ++n)
        if (n != ONLY_ORDER) hits.crossing[n] = vec2(0.0);
#endif
    return hits;
}

#if DISK_ORDERS_SHOWN_TINTED
// Colours of the view of orders (blackhole_gl/rendering/views.py) as linear light of luminance 1.
vec3 order_tint(Hits hits, vec2 point) {
    return point == hits.crossing[0] ? vec3(2.93, 0.52, 0.05) : point == hits.crossing[1] ? vec3(0.05, 1.33, 0.57) : vec3(0.53, 0.68, 5.61);
}
#endif
