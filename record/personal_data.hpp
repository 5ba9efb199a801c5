/// \file The participants' identities and consents, in a separate file beside the database. Exports
/// take the versions of consent forms from it, and the rest for one person alone. Format:
/// docs/data-dictionary.md, "Personal data".
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::record {

/// One consent, and the participant's details at that time.
struct PersonalRecord {
  std::string participant;
  std::string consent_version;  ///< version of the form that was signed
  std::string consented_utc{};  ///< ISO 8601
  std::optional<int> age{};     ///< years; empty: not given then
  std::string gender{};         ///< in their own words; empty: not given then
  std::string contact{};        ///< empty: not given then

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
  /// \throws StoreError, with the remedy, if it cannot be made, or is a file of a newer version or
  ///   another kind
  explicit PersonalData(const std::filesystem::path& path);
  ~PersonalData();
  PersonalData(PersonalData&&) noexcept;
  PersonalData& operator=(PersonalData&&) noexcept;

  /// Adds a consent; earlier ones of the participant are retained.
  /// \throws StoreError if it cannot be written
  void put(const PersonalRecord& record);
  /// The participant's last consent, with the latest age, gender and contact.
  [[nodiscard]] std::optional<PersonalRecord> find(const std::string& participant) const;
  /// Every consent, by participant, each participant's in the order in which they were recorded.
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
