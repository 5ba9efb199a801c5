/// \file One of the two copies of the record in a head file: text, signature, and padding with
/// spaces to a fixed size. Format: docs/data-dictionary.md, "Head file".
#pragma once

#include "core/public_keys.hpp"
#include "record/head_file.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace touchtrial::record {

inline constexpr std::size_t kHeadCopyBytes = 12288;

/// The result of reading a copy.
struct HeadCopy {
  std::string bytes;
  std::optional<HeadRecord> record;
  std::string fault;  ///< why the record is missing
  /// The owner that a complete copy names if no valid signer signed it.
  std::string claim;
};

/// The bytes of a copy.
/// \pre record.sessions has at most kMaxHeadSessions
/// \throws FileError, naming `path`, if the record is too long or has a name that is not UTF-8
[[nodiscard]] std::string head_copy_of(const HeadRecord& record, const Signer& signer,
                                       const std::filesystem::path& path);

/// \param bytes  possibly damaged
/// \param signers  valid public keys
[[nodiscard]] HeadCopy read_head_copy(std::string bytes, std::span<const PublicKey> signers);

/// Parses the text of a copy.
/// \throws StudyError if it is not a record
[[nodiscard]] HeadRecord head_record_from(std::string_view text, const std::string& source);

/// \throws FileError, naming the file, on one line
[[noreturn]] void refuse_head(const std::filesystem::path& path, const std::string& reason);

}  // namespace touchtrial::record
