// Members of a deform group in one pass: each point shows all of them, from back to front. So a
// part of the mesh that covers another one covers it with all members, as one flat picture would.

in vec2 texture_uv;

out vec4 colour;

uniform vec4 windows[MEMBERS];      // factors and offsets of each member's texture coordinates
uniform float opacities[MEMBERS];   // of an unclipped member, together with those clipped to it
uniform float clipped[MEMBERS];     // 1 for a member clipped to the last unclipped one
uniform sampler2D member_0;
uniform sampler2D member_1;
#if MEMBERS > 2
uniform sampler2D member_2;
#endif
#if MEMBERS > 3
uniform sampler2D member_3;
#endif
#if MEMBERS > 4
uniform sampler2D member_4;
#endif
#if MEMBERS > 5
uniform sampler2D member_5;
#endif
#if MEMBERS > 6
uniform sampler2D member_6;
#endif
#if MEMBERS > 7
uniform sampler2D member_7;
#endif


vec4 stack = vec4(0.0);   // the last unclipped member with those clipped to it
float faded = 1.0;        // its opacity
Footprint foot;

void lay() {
    stack *= faded;
    colour = stack + (1.0 - stack.a) * colour;
}

void add(sampler2D source, int k) {
    vec2 place = (texture_uv * windows[k].xy + windows[k].zw) * vec2(textureSize(source, 0)) - 0.5;
    vec4 own = sample_of(source, place, foot);
    if (clipped[k] > 0.5) {
        own *= opacities[k];
        stack.rgb = own.rgb * stack.a + (1.0 - own.a) * stack.rgb;
        return;
    }
    lay();
    stack = own;
    faded = opacities[k];
}

void main() {
    colour = vec4(0.0);
    // All members have pixels of one size.
    foot = footprint_at(texture_uv * windows[0].xy * vec2(textureSize(member_0, 0)));
    add(member_0, 0);
    add(member_1, 1);
#if MEMBERS > 2
    add(member_2, 2);
#endif
#if MEMBERS > 3
    add(member_3, 3);
#endif
#if MEMBERS > 4
    add(member_4, 4);
#endif
#if MEMBERS > 5
    add(member_5, 5);
#endif
#if MEMBERS > 6
    add(member_6, 6);
#endif
#if MEMBERS > 7
    add(member_7, 7);
#endif
    lay();
}
