#include "house/declarations.hpp"

#include "house/tokens.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace touchtrial::house {
namespace {

using Words = std::vector<std::string>;  // tokens; a pair of brackets with its content is one

const std::string kAnonymous = "(anonymous)";
const std::string kInitialiser = "{}";
const std::string kCondition = "{requires}";
const std::string kBody = "}";  // of a type: a variable may follow

bool is_group(const std::string& word, char bracket) {
  return word.size() > 1 && word.front() == bracket;
}

bool holds(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The place after a word, or the end.
std::size_t after(const Words& words, const std::string& word) {
  const auto found = std::find(words.begin(), words.end(), word);
  return static_cast<std::size_t>(found - words.begin()) + (found == words.end() ? 0 : 1);
}

std::string joined(const Words& words) {
  std::string all;
  for (const std::string& word : words) all += word;
  return all;
}

/// Where the bracket at a place is closed, or the end.
std::size_t closing(const Tokens& tokens, std::size_t at) {
  static const std::map<std::string, std::string> pairs = {
      {"(", ")"}, {"[", "]"}, {"{", "}"}, {"<", ">"}};
  const bool is_angle = tokens[at] == "<";
  const std::string& close = pairs.at(tokens[at]);
  for (++at; at < tokens.size(); ++at) {
    if (tokens[at] == close) return at;
    if (is_angle && tokens[at] == ";") break;
    if (pairs.count(tokens[at]) > 0 && (is_angle || tokens[at] != "<")) at = closing(tokens, at);
  }
  return tokens.size();
}

/// The qualified name before a place, for instance "Plane<float>::~Plane"; "" if there is none.
std::string name_before(const Words& words, std::size_t end) {
  std::size_t from = end;
  for (;;) {
    if (from > 1 && is_group(words[from - 1], '<')) --from;
    if (from == 0 || !is_name(words[from - 1])) return "";
    --from;
    if (from > 0 && words[from - 1] == "~") --from;
    if (from < 2 || words[from - 1] != "::" || words[from - 2] == "::") break;
    if (!is_name(words[from - 2]) && !is_group(words[from - 2], '<')) break;
    --from;
  }
  return joined(Words(words.begin() + static_cast<std::ptrdiff_t>(from),
                      words.begin() + static_cast<std::ptrdiff_t>(end)));
}

/// The place of the parameters of a function that is declared; the end if it is none.
std::size_t parameters_at(const Words& words) {
  static const std::set<std::string> ends = {"=", ":", "->", kInitialiser};
  std::size_t found = words.size();
  for (std::size_t i = 1; i < words.size() && ends.count(words[i]) == 0; ++i) {
    const bool is_named = is_name(words[i - 1]) || is_group(words[i - 1], '<');
    const bool is_pointer = words[i].starts_with("( *") || words[i].starts_with("( &");
    const bool is_condition = words[i - 1] == "requires";
    if (is_group(words[i], '(') && is_named && !is_pointer && !is_condition) found = i;
  }
  return found;
}

const std::set<std::string>& type_keys() {
  static const std::set<std::string> keys = {"class", "struct", "union", "enum"};
  return keys;
}

/// The place of "class" and the like; the end if there is none.
std::size_t type_key_at(const Words& words) {
  std::size_t i = 0;
  while (i < words.size() && words[i] != "=" && type_keys().count(words[i]) == 0) ++i;
  return i < words.size() && words[i] != "=" ? i : words.size();
}

/// Where the name of a type ends; 0 if the words before a "{" begin none.
std::size_t type_head(const Words& words) {
  static const std::set<std::string> ends_of_functions = {"const", "noexcept", "override"};
  std::size_t end = type_key_at(words);
  if (end == words.size()) return 0;
  while (end < words.size() && words[end] != ":") ++end;
  const std::string& last = words[end - 1];
  if (is_group(last, '(') || ends_of_functions.count(last) > 0) return 0;
  return last == "final" ? end - 1 : end;
}

/// Whether a "{" after these words begins what a template requires.
bool begins_condition(const Words& words) {
  const std::size_t size = words.size();
  if (size == 0 || holds(words, "=")) return false;
  if (words.back() == "requires") return true;
  if (size < 3 || !is_group(words.back(), '(') || words[size - 2] != "requires") return false;
  return words[size - 3] == "requires" || words[size - 3] == "&" || words[size - 3] == "|";
}

/// Whether a "{" after these words begins the value of a variable or of a member.
bool begins_value(const Words& words) {
  if (holds(words, "=")) return true;
  if (type_head(words) > 0) return false;
  if (parameters_at(words) == words.size()) return true;
  return holds(words, ":") && (is_name(words.back()) || is_group(words.back(), '<'));
}

/// The name of the variable or of the typedef that is declared.
std::string declared_name(const Words& words) {
  std::size_t end = 0;
  while (end < words.size() && words[end] != "=" && words[end] != kInitialiser) ++end;
  const std::size_t all = end;
  while (end > 0 && (is_group(words[end - 1], '[') || is_group(words[end - 1], '('))) --end;
  const bool is_pointer =
      end < all && (words[end].starts_with("( *") || words[end].starts_with("( &"));
  if (!is_pointer) return name_before(words, end);
  const Tokens inner = tokens_of(words[end]).tokens;
  return name_before(inner, inner.size() - 1);
}

/// Parameters without their names and default values, which make no other function.
std::string types_of(const Tokens& parameters) {
  std::string types;
  Tokens one;
  int depth = 0;
  bool in_default = false;
  const auto end_parameter = [&] {
    static const std::set<std::string> no_types = {"const", "volatile", "struct", "class",
                                                   "enum",  "typename", "::"};
    static const std::set<std::string> no_names = {"int",    "char",     "long",   "short",
                                                   "double", "unsigned", "signed", "const"};
    const bool is_named = one.size() > 1 && is_name(one.back()) &&
                          no_names.count(one.back()) == 0 &&
                          no_types.count(one[one.size() - 2]) == 0;
    if (is_named) one.pop_back();
    for (const std::string& token : one) types += token + " ";
    one.clear();
    in_default = false;
  };
  for (std::size_t i = 1; i + 1 < parameters.size(); ++i) {
    const std::string& token = parameters[i];
    if (token == "[" && parameters[i + 1] == "[") {
      i = closing(parameters, i);
      continue;
    }
    if (token == "<" || token == "(" || token == "{" || token == "[") ++depth;
    if (token == ">" || token == ")" || token == "}" || token == "]") --depth;
    if (depth == 0 && token == ",") {
      end_parameter();
      types += ", ";
    } else {
      in_default = in_default || (depth == 0 && token == "=");
      if (!in_default) one.push_back(token);
    }
  }
  end_parameter();
  return types;
}

/// Reads the statements of a namespace, one after another.
class Reader {
 public:
  explicit Reader(TokensOfFile file) : tokens_(std::move(file.tokens)) {
    found_.includes = std::move(file.includes);
  }

  Declarations read() {
    scope("");
    found_.is_complete = found_.is_complete && at_ == tokens_.size();
    return std::move(found_);
  }

 private:
  void scope(const std::string& space) {
    Words words;
    for (; at_ < tokens_.size() && tokens_[at_] != "}"; ++at_) {
      const std::string& token = tokens_[at_];
      if (token == ";") {
        ended(space, words);
        words.clear();
      } else if (token == "{") {
        opened(space, words);
      } else if (token == "operator") {
        words.push_back(operator_name());
      } else if (token == "(" || token == "[" || (token == "<" && begins_arguments(words))) {
        bracket(words);
      } else {
        words.push_back(token);
      }
    }
  }

  static bool begins_arguments(const Words& words) {
    return !words.empty() && is_name(words.back()) && !holds(words, "=");
  }

  /// Leaves out attributes, and what stands in the brackets of "alignas" and the like.
  void bracket(Words& words) {
    static const std::set<std::string> no_parameters = {"alignas",       "decltype", "noexcept",
                                                        "__attribute__", "explicit", "__declspec"};
    const bool is_attribute =
        tokens_[at_] == "[" && at_ + 1 < tokens_.size() && tokens_[at_ + 1] == "[";
    const bool is_unneeded = is_attribute || (tokens_[at_] == "(" && !words.empty() &&
                                              no_parameters.count(words.back()) > 0);
    const std::string group = skip_group();
    if (!is_unneeded) words.push_back(group);
  }

  /// Goes to the end of a pair of brackets.
  /// \return all of it, with spaces between the tokens
  std::string skip_group() {
    const std::size_t end = closing(tokens_, at_);
    std::string all = tokens_[at_++];
    for (; at_ < end; ++at_) all += " " + tokens_[at_];
    if (end == tokens_.size()) {
      found_.is_complete = false;
    } else {
      all += " " + tokens_[end];
    }
    return all;
  }

  std::string operator_name() {
    std::string name = "operator";
    if (at_ + 2 < tokens_.size() && tokens_[at_ + 1] == "(") {
      at_ += 2;
      return name + "()";
    }
    while (at_ + 1 < tokens_.size() && tokens_[at_ + 1] != "(" && tokens_[at_ + 1] != ";") {
      ++at_;
      name += (is_name(tokens_[at_]) ? " " : "") + tokens_[at_];
    }
    return name;
  }

  /// At a "{" after the words of a statement; takes the words if its "}" ends the statement.
  void opened(const std::string& space, Words& words) {
    if (holds(words, "namespace")) {
      inner_namespace(space, words);
      words.clear();
    } else if (words.size() == 2 && words.front() == "extern") {
      const bool outer = std::exchange(is_c_, true);
      inner_scope(space);
      is_c_ = outer;
      words.clear();
    } else {
      skip_group();
      holds_more(space);
      if (begins_condition(words)) {
        words.push_back(kCondition);
      } else if (begins_value(words)) {
        words.push_back(kInitialiser);
      } else if (const std::size_t head = type_head(words); head > 0) {
        const std::string name = name_before(words, head);
        if (type_keys().count(name) == 0) add(Definition::Kind::type, space, name);
        words.resize(type_key_at(words));
        words.push_back(kBody);
      } else {
        function(space, words);
        words.clear();
      }
    }
  }

  void inner_namespace(const std::string& space, const Words& words) {
    std::string name;
    for (std::size_t i = after(words, "namespace"); i < words.size(); ++i) {
      if (words[i] != "inline") name += words[i];
    }
    const std::string inner = qualified(space, name.empty() ? kAnonymous : name);
    if (!is_anonymous(inner)) found_.namespaces.try_emplace(inner, false);
    inner_scope(inner);
  }

  void inner_scope(const std::string& space) {
    ++at_;
    scope(space);
    found_.is_complete = found_.is_complete && at_ < tokens_.size();
  }

  void ended(const std::string& space, const Words& words) {
    if (words.empty()) return;
    const bool is_value = holds(words, "=") || holds(words, kInitialiser);
    const bool is_function = parameters_at(words) < words.size();
    const bool is_forward = type_key_at(words) < words.size() && !is_value && !is_function;
    if (!is_forward) holds_more(space);
    if (holds(words, "typedef")) {
      alias(space, declared_name(words), words);
    } else if (is_forward || is_only_instantiated(words)) {
      return;
    } else if (holds(words, "using")) {
      use(space, words);
    } else if (holds(words, "concept")) {
      add(Definition::Kind::type, space, words[after(words, "concept")]);
    } else if (is_function) {
      if (words.back() == "default" || words.back() == "delete") function(space, words);
    } else {
      variable(space, words, is_value);
    }
  }

  static bool is_only_instantiated(const Words& words) {
    return words.size() > 1 && words[0] == "template" && !is_group(words[1], '<');
  }

  void use(const std::string& space, const Words& words) {
    const std::size_t name = after(words, "using");
    if (holds(words, "=")) {
      alias(space, words[name], words);
    } else if (name < words.size() && words[name] == "namespace") {
      found_.used_namespaces.push_back(name_before(words, words.size()));
    }
  }

  void alias(const std::string& space, const std::string& name, const Words& words) {
    add(Definition::Kind::type, space, name, "", false, joined(words));
  }

  void function(const std::string& space, const Words& words) {
    const std::size_t at = parameters_at(words);
    if (at == words.size() || words[at - 1] == "catch") return;
    std::string parameters = types_of(tokens_of(words[at]).tokens);
    for (std::size_t i = at + 1; i < words.size() && words[i] != ":"; ++i) {
      if (words[i] == "const" || words[i] == "&") parameters += ") " + words[i];
    }
    for (std::size_t i = after(words, "requires"); i < words.size(); ++i) {
      parameters += " " + words[i];
    }
    const std::string name = name_before(words, at);
    if ((is_c_ || words.front() == "extern") && !is_anonymous(space)) {
      add(Definition::Kind::function, "", "extern \"C\" " + name);
    } else {
      add(Definition::Kind::function, space, name, parameters, holds(words, "static"));
    }
  }

  void variable(const std::string& space, const Words& words, bool is_value) {
    if (words.size() < 2 || (holds(words, "extern") && !is_value)) return;
    if (words.front() == "namespace") return;
    const bool is_constant = holds(words, "const") || holds(words, "constexpr");
    const bool is_shared = holds(words, "inline") || holds(words, "extern");
    add(Definition::Kind::variable, space, declared_name(words), "",
        holds(words, "static") || (is_constant && !is_shared));
  }

  static std::string qualified(const std::string& space, const std::string& name) {
    return space.empty() ? name : space + "::" + name;
  }

  static bool is_anonymous(const std::string& space) {
    return space.find(kAnonymous) != std::string::npos;
  }

  void holds_more(const std::string& space) {
    const std::string named = space.substr(0, space.find("::" + kAnonymous));
    if (!named.empty() && !named.starts_with(kAnonymous)) found_.namespaces[named] = true;
  }

  void add(Definition::Kind kind, const std::string& space, const std::string& name,
           const std::string& parameters = "", bool is_internal = false,
           const std::string& aliased = "") {
    if (name.empty()) return;
    // A definition can stand outside of its namespace: "int touchtrial::engine::area() {".
    const std::string plain = name.substr(0, name.find('<'));
    if (space.empty() && plain.starts_with("touchtrial::")) {
      holds_more(plain.substr(0, plain.rfind("::")));
    }
    found_.definitions.push_back(
        {kind, qualified(space, name), parameters, is_internal || is_anonymous(space), aliased});
  }

  Tokens tokens_;
  std::size_t at_ = 0;
  bool is_c_ = false;  // in extern "C" {}
  Declarations found_;
};

}  // namespace

Declarations declarations_in(std::string_view text) {
  return Reader(tokens_of(text)).read();
}

}  // namespace touchtrial::house
