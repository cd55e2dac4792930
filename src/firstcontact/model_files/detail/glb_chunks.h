/// @file
/// The container of binary glTF files.

#pragma once

#include <optional>
#include <string_view>

#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {

/// The parts of a glTF file, as views into its bytes.
struct GlbChunks {
  std::string_view json;
  /// The first buffer of the document, if the file contains it.
  std::optional<std::string_view> binary;
};

/// Splits a GLB file of version 2 into its chunks. Chunks of other types are left out, as the
/// standard demands.
///
/// Bytes that begin as JSON does are a document of text: all of them are JSON.
///
/// Source: Khronos Group, "glTF 2.0 Specification", 4 (GLB file format).
///
/// @throws ParseError  neither form, a header of another version, a chunk that is cut off, two
/// binary chunks
[[nodiscard]] GlbChunks split_glb(std::string_view bytes, ReadingLog& log);

}  // namespace firstcontact::detail
