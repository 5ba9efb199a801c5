/// \file Who the participants are, in a separate file beside the database that no export reads.
/// Format: docs/data-dictionary.md, "Personal data".
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::store {

struct PersonalRecord {
  std::string participant;
  std::string consent_version;  ///< version of the form that was signed
  std::string consented_utc;    ///< ISO 8601
  std::optional<int> age;       ///< years
  std::string gender;           ///< in their own words; may be empty
  std::string contact;          ///< may be empty

  friend bool operator==(const PersonalRecord&, const PersonalRecord&) = default;
};

/// `<db>.personal`
[[nodiscard]] std::filesystem::path personal_data_path(const std::filesystem::path& database);

/// An SQLite file that only its owner may read, from its creation on. Deleted content is
/// overwritten. Not to be shared between threads.
class PersonalData {
 public:
  /// Opens it, or makes an empty one.
  /// \throws FileError, with the remedy, if others may read it
  /// \throws StoreError, with the remedy, if it cannot be made, or is a newer file or no such file
  explicit PersonalData(const std::filesystem::path& path);
  ~PersonalData();
  PersonalData(PersonalData&&) noexcept;
  PersonalData& operator=(PersonalData&&) noexcept;

  /// Adds a participant, or replaces the participant's record.
  /// \throws StoreError if it cannot be written
  void put(const PersonalRecord& record);
  [[nodiscard]] std::optional<PersonalRecord> find(const std::string& participant) const;
  /// \return whether there was such a participant
  /// \throws StoreError if it cannot be written
  bool remove(const std::string& participant);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::store
