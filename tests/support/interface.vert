// A vertex of the interface: panels, text, and pictures in them.

uniform vec4 place;    // scale and offset from pixels to clip space

in vec2 position;      // in pixels, y down
in vec2 uv;
in vec4 colour;        // straight

out vec2 texture_uv;
out vec4 tint;

void main() {
    texture_uv = uv;
    tint = colour;
    gl_Position = vec4(position * place.xy + place.zw, 0.0, 1.0);
}
