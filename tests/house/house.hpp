/// \file Checks the rules of docs/architecture.md on the sources of a tree. Every function returns
///   the violations of its rule, one line each.
#pragma once

#include "house/declarations.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::house {

/// A folder with a static library of its own, and an arrow to each folder that it may include.
struct Room {
  std::string folder;
  std::string name_space;
  std::set<std::string> arrows;  ///< folders
  bool sees_inside = false;  ///< may include private headers of others, and the tests' references
};

[[nodiscard]] const std::vector<Room>& rooms();

struct SourceFile {
  std::string path;  ///< from the root
  const Room* room = nullptr;
  std::string text;
  std::vector<std::string> quoted;  ///< what it includes, in the order of its lines
  std::vector<std::string> angled;
  Declarations declared;

  [[nodiscard]] bool is_header() const { return path.ends_with(".hpp"); }
  /// Whether the header is included once for every SIMD target.
  [[nodiscard]] bool once_a_target() const { return path.ends_with("-inl.hpp"); }
};

class House {
 public:
  /// Reads all sources of all rooms below a root.
  /// \throws std::filesystem::filesystem_error
  explicit House(std::filesystem::path root);

  [[nodiscard]] const std::vector<SourceFile>& files() const { return files_; }

  /// Sources beside the rooms, or with another ending than .hpp and .cpp: no rule reads them.
  [[nodiscard]] const std::vector<std::string>& not_read() const { return not_read_; }
  /// Includes of what is not there or not read, of what is in no room, and against the arrows.
  [[nodiscard]] std::vector<std::string> wrong_includes() const;
  /// Headers that include a third-party header, directly or through another header, and are
  /// included in another room.
  [[nodiscard]] std::vector<std::string> third_party_headers_shown() const;
  /// Headers whose first comment says "Private to", included from outside their folder.
  [[nodiscard]] std::vector<std::string> private_headers_used_elsewhere() const;
  /// Types, functions and variables that two files define under one qualified name. Those that
  /// belong to their source alone may not meet another of their folder.
  [[nodiscard]] std::vector<std::string> names_defined_twice() const;
  /// Files that declare more in another room's namespace than its types, define something in no
  /// namespace, or open none of their own, and headers that use all of a namespace.
  [[nodiscard]] std::vector<std::string> namespaces_of_other_rooms() const;
  /// Headers that do not guard themselves or do not say what they are for, and files with a bracket
  /// that has no partner, of which the rest was not read.
  [[nodiscard]] std::vector<std::string> unguarded_or_unexplained_headers() const;

 private:
  void read(const std::string& path);
  [[nodiscard]] const SourceFile* find(const std::string& path) const;

  std::filesystem::path root_;
  std::vector<SourceFile> files_;
  std::vector<std::string> not_read_;
};

}  // namespace touchtrial::house
