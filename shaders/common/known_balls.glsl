// The balls that a ray may meet, as coarse rays have told of the cells of the picture (reach_cells.frag).

uniform usampler2D cell_balls;  // a bit for each ball that may be the first that is met in the cell
uniform sampler2D reach_balls;  // common/reach.glsl

uniform float stray_seen;       // r_s for each r_s from the camera: by how much outlines made of many parts may be displaced in a picture that moves

uint known_balls = 0u;  // those of this ray

struct KnownBall {
    vec3 centre;  // r_s
    float radius;
    int kind, index;  // of what lies in it
};

uint balls_of_cell(ivec2 cell) {
    return texelFetch(cell_balls, clamp(cell, ivec2(0), textureSize(cell_balls, 0) - 1), 0).r;
}

// To be told once: the balls at `place` in the picture, or at a corner of cells.
void know_balls(vec2 place, bool is_corner) {
    ivec2 cell = ivec2(floor(place / float(REFINE_STEP)));
    known_balls = balls_of_cell(cell);
    if (is_corner) known_balls |= balls_of_cell(cell - ivec2(1, 0)) | balls_of_cell(cell - ivec2(0, 1)) | balls_of_cell(cell - 1);
}

// The first of those `left`, of which there is one, and takes it from them.
KnownBall next_ball(inout uint left) {
    float column = (float(lowest_bit(left)) + 0.5) / float(textureSize(reach_balls, 0).x);  // the nearest texel: docs/llvmpipe.md, texels
    vec4 ball = textureLod(reach_balls, vec2(column, 0.25), 0.0);
    int of = int(textureLod(reach_balls, vec2(column, 0.75), 0.0).x + 0.5) - 1;
    left = without_lowest(left);
    return KnownBall(ball.xyz, abs(ball.w), of & 31, of >> 5);
}

// How far from where it is a way may be looked at where it passes x, r_s.
float unseen_stray(vec3 x) {
    return stray_seen * distance(x, camera_n.xyz * (0.5 / camera_w));
}

// Whether the straight piece from x to y comes into the ball, or as near to it as that.
bool comes_near(KnownBall ball, vec3 x, vec3 y, float stray) {
    vec3 off = ball.centre - x, way = y - x;
    float within = ball.radius + stray + rounding(x, y);
    off -= clamp(dot(off, way) / max(dot(way, way), 1e-30), 0.0, 1.0) * way;
    return dot(off, off) <= within * within;
}
