// The drawing in its own colours.

in vec2 texture_uv;

out vec4 colour;

vec4 picture_at(vec2 uv);

void main() {
    colour = picture_at(texture_uv);
}
