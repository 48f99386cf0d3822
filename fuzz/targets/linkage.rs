#![no_main]
//! A linkage document that is read is resolved, and written so that it reads back to itself.
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(reading) = linkage_schema::read(bytes, "input.xml".as_ref()) else { return };
    let Ok(document) = reading.accept() else { return };
    linkage_schema::resolve(&document);
    let mut text = Vec::new();
    // What XML has no character for may come in by a reference; it is refused, not lost.
    if linkage_schema::write(&document, &mut text).is_err() {
        return;
    }
    let again = linkage_schema::read(&text[..], "input.xml".as_ref()).expect("what was written is read");
    let again = again.accept().expect("what was written is accepted");
    let mut second = Vec::new();
    linkage_schema::write(&again, &mut second).expect("memory takes what is written");
    assert_eq!(String::from_utf8_lossy(&text), String::from_utf8_lossy(&second));
});
