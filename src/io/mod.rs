//! Files in, files out: wire types, diagnostics with line and column, schemas.
//!
//! The only module that names `serde`.
