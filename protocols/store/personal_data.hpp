/// \file Who the participants are: a file of its own beside the database, which nothing exports.
/// Format: docs/data-dictionary.md, "Personal data".
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::store {

struct PersonalRecord {
  std::string participant;
  std::string consent_version;  ///< that was signed
  std::string consented_utc;    ///< ISO 8601
  std::optional<int> age;       ///< years
  std::string gender;           ///< in their own words; may be empty
  std::string contact;          ///< may be empty

  friend bool operator==(const PersonalRecord&, const PersonalRecord&) = default;
};

/// `<db>.personal`
[[nodiscard]] std::filesystem::path personal_data_path(const std::filesystem::path& database);

/// An SQLite file that its owner alone may read, from the moment of its making. Deleted content is
/// overwritten. Not to be shared between threads.
class PersonalData {
 public:
  /// Opens it, or makes an empty one.
  /// \throws StoreError if others may read it (and how to mend that), it cannot be made, or it is
  ///   no such file or a newer one
  explicit PersonalData(const std::filesystem::path& path);
  ~PersonalData();
  PersonalData(PersonalData&&) noexcept;
  PersonalData& operator=(PersonalData&&) noexcept;

  /// Adds somebody, or changes what is known of them. \throws StoreError if it cannot be written
  void put(const PersonalRecord& record);
  [[nodiscard]] std::optional<PersonalRecord> find(const std::string& participant) const;
  /// \return whether there was somebody to remove \throws StoreError if it cannot be written
  bool remove(const std::string& participant);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::store
