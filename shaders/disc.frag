// A disc with a rim; both edges are smooth.

in vec2 offset;
flat in vec3 disc;
flat in vec4 disc_fill;
flat in vec4 disc_rim;

out vec4 colour;

vec4 premultiplied(vec4 straight) {
    return vec4(straight.rgb * straight.a, straight.a);
}

void main() {
    float away = length(offset);
    float coverage = smoothstep(0.0, 1.0, clamp((disc.x - away) / disc.z + 0.5, 0.0, 1.0));
    float inside = disc.y > 0.0 ? clamp(disc.x - disc.y - away + 0.5, 0.0, 1.0) : 1.0;
    colour = mix(premultiplied(disc_rim), premultiplied(disc_fill), inside) * coverage;
}
