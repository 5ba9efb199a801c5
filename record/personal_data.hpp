/// \file The participants' identities and consents, in a separate file beside the database. Exports
/// contain only the versions of consent forms, except the export for one person. Format:
/// docs/data-dictionary.md, "Personal data".
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::record {

/// One consent, and the details that the participant gave with it.
struct PersonalRecord {
  std::string participant;
  std::string consent_version;  ///< version of the signed form
  std::string consented_utc{};  ///< ISO 8601
  std::optional<int> age{};     ///< years; empty: not stated
  std::string gender{};         ///< in their own words; empty: not stated
  std::string contact{};        ///< empty: not stated

  friend bool operator==(const PersonalRecord&, const PersonalRecord&) = default;
};

/// `<db>.personal`
[[nodiscard]] std::filesystem::path personal_data_path(const std::filesystem::path& database);

/// An SQLite file that only its owner may read, from its creation on. Deleted content is
/// overwritten. Not thread-safe.
class PersonalData {
 public:
  /// Opens the file, or creates an empty one.
  /// \throws FileError, with the remedy, if others may read it
  /// \throws StoreError, with the remedy, if it cannot be created, or has another version or kind
  explicit PersonalData(const std::filesystem::path& path);
  ~PersonalData();
  PersonalData(PersonalData&&) noexcept;
  PersonalData& operator=(PersonalData&&) noexcept;

  /// Adds a consent; earlier ones of the participant are retained.
  /// \throws StoreError if it cannot be written
  void put(const PersonalRecord& record);
  /// The participant's last consent, with the latest age, gender and contact.
  [[nodiscard]] std::optional<PersonalRecord> find(const std::string& participant) const;
  /// Every consent, by participant and in the order of recording.
  [[nodiscard]] std::vector<PersonalRecord> all() const;
  /// Removes every consent of a participant.
  /// \return whether the participant had any
  /// \throws StoreError if it cannot be written
  bool remove(const std::string& participant);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::record
