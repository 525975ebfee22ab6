// The interface: every pixel of it is of a texture, with glyphs and plain colours among them.

uniform sampler2D image;   // straight

in vec2 texture_uv;
in vec4 tint;

out vec4 colour;

void main() {
    colour = tint * texture(image, texture_uv);
}
