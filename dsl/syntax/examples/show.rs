fn main() {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path).unwrap();
        let parsed = fragbuf_syntax::parse(&text, &path);
        println!("// {path}\n{}", parsed.diagnostics);
        if let Some(d) = parsed.draft {
            for f in d.helpers.iter().chain(d.keep.as_ref().and_then(|k| k.criterion.as_ref())).chain(&d.constraints).chain(&d.resolve) {
                println!("{}", f.wgsl);
                if f.wgsl.lines().count() != f.lines.len() { println!("LINES DIFFER"); }
            }
        }
    }
}
