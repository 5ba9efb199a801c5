/// \file What `prepare` knows of the pictures and fields of its last run. Private to
/// protocols/design. Format: docs/data-dictionary.md, "Notes of prepare".
#pragma once

#include "core/file_stamp.hpp"
#include "core/hash.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

struct PictureNote {
  FileStamp stamp;
  Digest pixels{};  ///< of its size and grey levels
  std::int64_t size_px = 0;
};

struct FieldNote {
  Digest recipe{};  ///< of method and rendering
  Digest pixels{};  ///< of the picture
  Digest tag{};     ///< input_tag of both
  Digest checksum{};
  FileStamp stamp;  ///< of the field's file when it had this checksum
};

/// What follows from all fields together.
struct MeasuredFields {
  Digest of{};  ///< of the fields and the study
  engine::StudyGains gains;
  std::vector<std::string> remarks;                 ///< on gains by level
  std::vector<std::uint8_t> flat;                   ///< whether nothing of a field can be felt
  std::vector<engine::FieldStatistics> statistics;  ///< empty if nobody asked for them
};

struct PrepareNotes {
  std::map<std::string, PictureNote> pictures;  ///< by absolute path
  std::map<std::string, FieldNote> fields;      ///< by code
  std::optional<MeasuredFields> measured;
};

[[nodiscard]] std::string text_of_notes(const PrepareNotes& notes);
/// \return no notes if the text is none of text_of_notes
[[nodiscard]] PrepareNotes notes_of_text(const std::string& text);

}  // namespace touchtrial::design
