/// \file What a C++ file defines in its namespaces, read well enough for this project's own
/// sources: no preprocessing, no templates resolved.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::house {

/// A type, a function or a variable that a file defines, under its qualified name.
struct Definition {
  enum class Kind { type, function, variable };
  Kind kind{};
  std::string name;        ///< for instance "touchtrial::store::StudyStore"
  std::string parameters;  ///< of a function, as written but for white space; "" otherwise
  bool is_inline = false;  ///< says inline, constexpr or template

  friend bool operator==(const Definition&, const Definition&) = default;
};

struct Declarations {
  std::vector<Definition> definitions;
  /// Qualified, and whether it holds more than forward declarations of types. The anonymous ones
  /// and what is in them are left out.
  std::map<std::string, bool> namespaces;
};

/// Reads a header or a source. What stands in an anonymous namespace belongs to its file alone and
/// is left out, as are members that are defined in their class.
[[nodiscard]] Declarations declarations_in(std::string_view text);

}  // namespace touchtrial::house
