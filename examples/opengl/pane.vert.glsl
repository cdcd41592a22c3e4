layout(location = 0) in vec3 position;
layout(location = 1) in vec4 color;

uniform mat4 view_projection;

out vec3 surface_position;
out vec4 surface_color;

void main() {
    surface_position = position;
    surface_color = color;
    gl_Position = view_projection * vec4(position, 1.0);
}
