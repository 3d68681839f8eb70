//! Structs that the host and the shaders share, and what lets a test compare them offset by offset.

/// A host struct's name, size and fields (name, offset, size in bytes), to hold against a shader's reflection.
pub struct SharedLayout {
    pub name: &'static str,
    pub size: usize,
    pub fields: &'static [(&'static str, usize, usize)],
}

/// Declares a plain struct that shaders read under the same name, and its [`SharedLayout`].
#[macro_export]
macro_rules! shared_struct {
    ($(#[$meta:meta])* pub struct $name:ident { $($(#[$field_meta:meta])* pub $field:ident: $ty:ty,)* }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Debug, Clone, Copy, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        pub struct $name { $($(#[$field_meta])* pub $field: $ty,)* }

        impl $name {
            pub const LAYOUT: $crate::gpu::shared::SharedLayout = $crate::gpu::shared::SharedLayout {
                name: stringify!($name),
                size: size_of::<$name>(),
                fields: &[$((stringify!($field), std::mem::offset_of!($name, $field), size_of::<$ty>()),)*],
            };
        }
    };
}
