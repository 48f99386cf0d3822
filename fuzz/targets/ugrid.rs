#![no_main]
// How the numbers are written stands in the name.
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for ending in ["ugrid", "lb8.ugrid", "b8.ugrid", "lb4.ugrid", "lr8.ugrid", "lb8l.ugrid", "ugrid64"] {
        sagitta_fuzz::read(bytes, ending);
    }
});
