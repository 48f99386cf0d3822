//! Finds Debian's OCCT by its version header, compiles the shim, names the libraries.

use std::path::{Path, PathBuf};

const INCLUDE_DIRS: [&str; 3] =
    ["/usr/include/opencascade", "/usr/local/include/opencascade", "/opt/include/opencascade"];
const SHIM: [&str; 7] = ["geometry", "shape", "instances", "import", "oracle", "place", "airfoil"];

fn main() {
    println!("cargo:rerun-if-env-changed=OCCT_INCLUDE_DIR");
    println!("cargo:rerun-if-env-changed=OCCT_LIB_DIR");
    println!("cargo:rerun-if-changed=src/lib.rs");
    println!("cargo:rerun-if-changed=shim");
    let include = match include_dir() {
        Some(dir) => dir,
        None => fail("no Standard_Version.hxx found; install it with: apt-get install g++ libocct-data-exchange-dev"),
    };
    let version = match version(&include.join("Standard_Version.hxx")) {
        Some(version) if version >= (7, 6) => version,
        Some((major, minor)) => fail(&format!("OCCT {major}.{minor} is too old: 7.6 or newer is needed")),
        None => fail(&format!("no version in {}", include.join("Standard_Version.hxx").display())),
    };
    let mut build = cxx_build::bridge("src/lib.rs");
    build.std("c++17").opt_level(2).include("shim").flag("-isystem").flag(include.to_string_lossy().as_ref());
    build.flag_if_supported("-Wno-deprecated-declarations");
    for name in SHIM {
        build.file(format!("shim/{name}.cxx"));
    }
    build.compile("sagitta_occt_shim");
    if let Some(dir) = std::env::var_os("OCCT_LIB_DIR") {
        println!("cargo:rustc-link-search=native={}", Path::new(&dir).display());
    }
    for library in libraries(version) {
        println!("cargo:rustc-link-lib=dylib={library}");
    }
}

fn fail(message: &str) -> ! {
    println!("cargo:warning=opencascade-sys: {message}");
    std::process::exit(1)
}

fn include_dir() -> Option<PathBuf> {
    let asked = std::env::var_os("OCCT_INCLUDE_DIR").map(PathBuf::from);
    asked.into_iter().chain(INCLUDE_DIRS.map(PathBuf::from)).find(|dir| dir.join("Standard_Version.hxx").is_file())
}

/// Major and minor number from the two `#define`s of the version header.
fn version(header: &Path) -> Option<(u32, u32)> {
    let text = std::fs::read_to_string(header).ok()?;
    let number = |name: &str| -> Option<u32> {
        text.lines().find_map(|line| line.strip_prefix("#define ")?.strip_prefix(name)?.trim().parse().ok())
    };
    Some((number("OCC_VERSION_MAJOR")?, number("OCC_VERSION_MINOR")?))
}

/// Data exchange was renamed in 7.8; the others kept their names.
fn libraries(version: (u32, u32)) -> Vec<&'static str> {
    let exchange: &[&str] =
        if version >= (7, 8) { &["TKDESTEP", "TKDEIGES"] } else { &["TKSTEP", "TKSTEPBase", "TKSTEPAttr", "TKIGES"] };
    let common = [
        "TKXSBase",
        "TKShHealing",
        "TKTopAlgo",
        "TKBRep",
        "TKGeomAlgo",
        "TKGeomBase",
        "TKG3d",
        "TKG2d",
        "TKMath",
        "TKernel",
    ];
    exchange.iter().copied().chain(common).collect()
}
