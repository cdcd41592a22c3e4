fn user_unsigned(a: u32, n: u32) -> u32 {
    var sum = 0u;
    for (var i = 0u; i <= 3u; i++) {
        sum += i;
    }
    for (var i_next = 4u; i_next > 0u; i_next--) {
        let i = i_next - 1u;
        sum ^= i;
    }
    var i_more = a <= n;
    for (var i = a; i_more; i++) {
        i_more = i < n;
        if i % 2u == 0u {
            continue;
        }
        sum += i;
    }
    var i_more_1 = a <= n;
    for (var i = n; i_more_1; i--) {
        i_more_1 = i > a;
        if i == uniforms.last {
            break;
        }
        sum += i;
    }
    let i_start = a + 1u;
    let i_end = uniforms.last - 1u;
    var i_more_2 = i_start <= i_end;
    for (var i = i_start; i_more_2; i++) {
        i_more_2 = i < i_end;
        sum += i;
    }
    let i_start_1 = a + 1u;
    let i_end_1 = uniforms.last - 1u;
    var i_more_3 = i_start_1 <= i_end_1;
    for (var i = i_end_1; i_more_3; i--) {
        i_more_3 = i > i_start_1;
        sum += i;
    }
    var i_more_4 = 4294967293u <= 4294967295u;
    for (var i = 4294967293u; i_more_4; i++) {
        i_more_4 = i < 4294967295u;
        sum ^= i;
    }
    var i_more_5 = 4294967293u <= 4294967295u;
    for (var i = 4294967295u; i_more_5; i--) {
        i_more_5 = i > 4294967293u;
        sum ^= i;
    }
    var index_more = 1u <= n;
    for (var index = 1u; index_more; index++) {
        index_more = index < n;
        sum += 1u;
    }
    var index_more_1 = 1u <= n;
    for (var index = n; index_more_1; index--) {
        index_more_1 = index > 1u;
        sum += 1u;
    }
    var m = n;
    let i_end_2 = m;
    var i_more_6 = true;
    for (var i = 0u; i_more_6; i++) {
        i_more_6 = i < i_end_2;
        m = i;
        var j_more = true;
        for (var j = 0u; j_more; j++) {
            j_more = j < i;
            sum += j;
        }
    }
    return sum;
}

fn user_signed(n: i32) -> i32 {
    var sum = 0i;
    var i_more = true;
    for (var i = i32(-2147483648); i_more; i++) {
        i_more = i < n;
        sum ^= i;
    }
    var i_more_1 = true;
    for (var i = n; i_more_1; i--) {
        i_more_1 = i > i32(-2147483648);
        sum ^= i;
    }
    var i_more_2 = uniforms.bias <= 2147483647i;
    for (var i = uniforms.bias; i_more_2; i++) {
        i_more_2 = i < 2147483647i;
        sum ^= i;
    }
    for (var i_next = 0i; i_next > -5i; i_next--) {
        let i = i_next - 1i;
        sum ^= i;
    }
    for (var i_next = -1i; i_next > -5i; i_next--) {
        let i = i_next - 1i;
        sum ^= i;
    }
    var i_more_3 = n <= 2147483647i;
    for (var i = 2147483647i; i_more_3; i--) {
        i_more_3 = i > n;
        sum ^= i;
    }
    return sum;
}

fn user_resolve() -> vec4<f32> {
    var color = vec4<f32>(0.0);
    for (var i = 1u; i <= layer_count(); i++) {
        color += layer(i - 1u).color;
    }
    var i_more = 1u <= layer_count();
    for (var i = layer_count(); i_more; i--) {
        i_more = i > 1u;
        color *= layer(i - 1u).depth;
    }
    for (var i = 1u; i <= layer_count(); i++) {
        color.x += f32(i);
    }
    return color;
}
