in vec3 surface_position;
in vec4 surface_color;

void main() {
    // Rings engraved in the glass.
    float rings = 0.75 + 0.25 * sin(60.0 * length(surface_position.xy));
    vec4 color = vec4(surface_color.rgb, surface_color.a * rings);
    store_fragment(gl_FragCoord.xy, Fragment(color, gl_FragCoord.z));
}
