#version 330 core
// The picture of a view from one that has directions at even steps of longitude and latitude, filtered linearly (blackhole_gl/rendering/turning.py).
#blocks

uniform sampler2D around;

noperspective in vec2 place;

out vec4 colour;

void main() {
    colour = textureLod(around, place, 0.0);
}
