// A sky brightens its light by the shift of its colours (`energy` of the contract in shade_sky.frag). This mends it where the observer's motion is to count for one
// and not for the other: `energies` as pixel_energies gives them.
float sky_beaming(vec2 energies) {
#if SKY_SHIFTS && (!CAMERA_ABERRATION || !CAMERA_DOPPLER_COLOUR || !CAMERA_BEAMING)
    float more = energies.y / energies.x;
    more *= more;
    return more * more;
#else
    return 1.0;
#endif
}
