#include "house/declarations.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>

namespace touchtrial::house {
namespace {

using Tokens = std::vector<std::string>;

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Cuts a text into words and punctuation; comments and preprocessor lines are gone, literals are
/// "".
class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  Tokens tokens() {
    while (at_ < text_.size()) next();
    return std::move(tokens_);
  }

 private:
  void next() {
    const char c = text_[at_];
    if (c == '\n') {
      line_is_empty_ = true;
      ++at_;
    } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++at_;
    } else if (c == '#' && line_is_empty_) {
      skip_directive();
    } else if (starts_with("//")) {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (starts_with("/*")) {
      skip_past("*/");
    } else {
      line_is_empty_ = false;
      token(c);
    }
  }

  void token(char c) {
    if (starts_with("R\"")) {
      const std::size_t open = text_.find('(', at_);
      skip_past(")" + std::string(text_.substr(at_ + 2, open - at_ - 2)) + "\"");
      tokens_.emplace_back("\"\"");
    } else if (c == '"' || c == '\'') {
      skip_literal(c);
    } else if (in_word(c)) {
      const std::size_t from = at_;
      while (at_ < text_.size() && (in_word(text_[at_]) || is_separator_of_digits(from))) ++at_;
      tokens_.emplace_back(text_.substr(from, at_ - from));
    } else {
      const std::size_t size = starts_with("::") ? 2 : 1;
      tokens_.emplace_back(text_.substr(at_, size));
      at_ += size;
    }
  }

  bool is_separator_of_digits(std::size_t from) const {
    return text_[at_] == '\'' && std::isdigit(static_cast<unsigned char>(text_[from])) != 0;
  }

  void skip_literal(char quote) {
    for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    ++at_;
    tokens_.emplace_back("\"\"");
  }

  void skip_directive() {
    while (at_ < text_.size() && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2 : 1;
  }

  void skip_past(const std::string& end) {
    const std::size_t found = text_.find(end, at_ + 2);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  bool starts_with(std::string_view what) const { return text_.substr(at_).starts_with(what); }

  std::string_view text_;
  std::size_t at_ = 0;
  bool line_is_empty_ = true;
  Tokens tokens_;
};

bool is_name(const std::string& token) {
  return !token.empty() && in_word(token.front());
}

bool holds(const Tokens& tokens, const std::string& word) {
  return std::find(tokens.begin(), tokens.end(), word) != tokens.end();
}

/// Where the bracket at a place is closed, or the end.
std::size_t closing(const Tokens& tokens, std::size_t at, const std::string& open,
                    const std::string& close) {
  std::size_t depth = 0;
  for (; at < tokens.size(); ++at) {
    if (tokens[at] == open) ++depth;
    if (tokens[at] == close && --depth == 0) return at;
  }
  return tokens.size();
}

/// Reads the statements of a namespace, one after another.
class Reader {
 public:
  explicit Reader(Tokens tokens) : tokens_(std::move(tokens)) {}

  Declarations read() {
    scope("");
    return std::move(found_);
  }

 private:
  void scope(const std::string& space) {
    Tokens statement;
    for (; at_ < tokens_.size(); ++at_) {
      const std::string& token = tokens_[at_];
      if (token == "}") return;
      if (token == ";") {
        ended(space, statement);
        statement.clear();
      } else if (token == "{") {
        if (opened(space, statement)) statement.clear();
      } else if (token == "(" || token == "[") {
        const std::size_t end = closing(tokens_, at_, token, token == "(" ? ")" : "]");
        for (; at_ < end; ++at_) statement.push_back(tokens_[at_]);
        if (end < tokens_.size()) statement.push_back(tokens_[end]);
      } else {
        statement.push_back(token);
      }
    }
  }

  /// At a "{" after the words of a statement. True if its "}" ends the statement.
  bool opened(const std::string& space, const Tokens& words) {
    const Tokens statement = without_template(words);
    if (!statement.empty() && (statement.front() == "namespace" || holds_namespace(statement))) {
      inner_namespace(space, statement);
      return true;
    }
    if (statement.size() == 2 && statement.front() == "extern") {
      ++at_;
      scope(space);
      return true;
    }
    at_ = closing(tokens_, at_, "{", "}");
    holds_more(space);
    if (defines_type(statement)) {
      add(Definition::Kind::type, space, type_name(statement), "", false);
      return false;  // a declaration of variables may follow, up to ";"
    }
    if (function(space, words)) return true;
    variable(space, words);
    return false;
  }

  void holds_more(const std::string& space) {
    if (!space.empty()) found_.namespaces[space] = true;
  }

  static bool holds_namespace(const Tokens& statement) {
    return statement.size() > 1 && statement[0] == "inline" && statement[1] == "namespace";
  }

  void inner_namespace(const std::string& space, const Tokens& statement) {
    const auto word = std::find(statement.begin(), statement.end(), "namespace");
    std::string name;
    for (auto it = word + 1; it != statement.end(); ++it) name += *it;
    if (name.empty()) {
      at_ = closing(tokens_, at_, "{", "}");
      return;
    }
    const std::string inner = space.empty() ? name : space + "::" + name;
    found_.namespaces.try_emplace(inner, false);
    ++at_;
    scope(inner);
  }

  void ended(const std::string& space, const Tokens& words) {
    const Tokens statement = without_template(words);
    if (!statement.empty() && !(defines_type(statement) && statement.size() == 2))
      holds_more(space);
    if (statement.size() > 2 && statement[0] == "using" && statement[2] == "=") {
      add(Definition::Kind::type, space, statement[1], "", false);
    } else {
      variable(space, words);
    }
  }

  static Tokens without_template(const Tokens& statement) {
    std::size_t from = 0;
    while (from < statement.size() && statement[from] == "template") {
      from = std::min(closing(statement, from + 1, "<", ">") + 1, statement.size());
    }
    return {statement.begin() + static_cast<std::ptrdiff_t>(from), statement.end()};
  }

  static bool defines_type(const Tokens& statement) {
    static const std::set<std::string> keys = {"class", "struct", "union", "enum"};
    const std::size_t first = !statement.empty() && statement.front() == "typedef" ? 1 : 0;
    return statement.size() > first && keys.count(statement[first]) > 0 && !is_function(statement);
  }

  static bool is_function(const Tokens& statement) {
    return !statement.empty() && statement.back() == ")" && !holds(statement, "alignas");
  }

  /// "class [[nodiscard]] Name final : Base" to "Name"; a specialisation with its arguments.
  static std::string type_name(const Tokens& statement) {
    static const std::set<std::string> keys = {"typedef", "class", "struct", "union", "enum"};
    std::string name;
    for (std::size_t i = 0; i < statement.size(); ++i) {
      if (statement[i] == "[") {
        i = closing(statement, i, "[", "]");
      } else if (statement[i] == "alignas") {
        i = closing(statement, i, "(", ")");
      } else if (statement[i] == ":" || statement[i] == "final") {
        break;
      } else if (keys.count(statement[i]) == 0) {
        name += statement[i];
      }
    }
    return name;
  }

  bool function(const std::string& space, const Tokens& words) {
    const Tokens statement = without_template(words);
    static const std::set<std::string> no_functions = {"requires", "decltype", "noexcept",
                                                       "alignas", "explicit"};
    for (std::size_t i = 1; i < statement.size(); ++i) {
      if (statement[i] == "=" && !names_operator(statement, i)) return false;
      if (statement[i] != "(" || no_functions.count(statement[i - 1]) > 0) continue;
      std::size_t first = i - 1;
      while (first > 0 && !is_name(statement[first])) --first;  // an operator's sign
      if (first > 0 && statement[first - 1] == "operator") --first;
      while (first > 1 && statement[first - 1] == "::") first = owner(statement, first - 2);
      std::string name;
      for (std::size_t k = first; k < i; ++k) name += statement[k];
      const std::size_t end = closing(statement, i, "(", ")");
      std::string parameters = types_of({statement.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                         statement.begin() + static_cast<std::ptrdiff_t>(end)});
      for (std::size_t k = end + 1; k < statement.size(); ++k) {
        if (statement[k] == "const") parameters += ") const";
      }
      add(Definition::Kind::function, space, name, parameters, is_inline(words));
      return true;
    }
    return false;
  }

  /// Whether a sign belongs to an operator's name, as in "operator <=".
  static bool names_operator(const Tokens& statement, std::size_t at) {
    while (at > 0 && !is_name(statement[at]) && statement[at] != ")") --at;
    return statement[at] == "operator";
  }

  /// Parameters without their names and default values, which make no other function.
  static std::string types_of(const Tokens& parameters) {
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
    for (const std::string& token : parameters) {
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

  /// The first token of the class before a member's "::", whose last token stands at a place.
  static std::size_t owner(const Tokens& statement, std::size_t at) {
    if (statement[at] != ">") return at;
    for (std::size_t depth = 1; depth > 0 && at > 0;) {
      --at;
      if (statement[at] == ">") ++depth;
      if (statement[at] == "<") --depth;
    }
    return at > 0 ? at - 1 : at;
  }

  /// A variable that says inline: one of a name in the whole program.
  void variable(const std::string& space, const Tokens& words) {
    if (!holds(words, "inline") || holds(words, "using")) return;
    const auto ends_name = [&](std::size_t i) {
      return i == words.size() || words[i] == "=" || (words[i] == "[" && is_name(words[i - 1]));
    };
    std::size_t end = 1;
    while (!ends_name(end)) ++end;
    if (!is_name(words[end - 1])) return;  // the end of a declared function
    add(Definition::Kind::variable, space, words[end - 1], "", true);
  }

  static bool is_inline(const Tokens& words) {
    return holds(words, "inline") || holds(words, "constexpr") || holds(words, "consteval") ||
           holds(words, "template");
  }

  void add(Definition::Kind kind, const std::string& space, const std::string& name,
           const std::string& parameters, bool is_inline) {
    if (name.empty()) return;
    const std::string qualified = space.empty() ? name : space + "::" + name;
    found_.definitions.push_back({kind, qualified, parameters, is_inline});
  }

  Tokens tokens_;
  std::size_t at_ = 0;
  Declarations found_;
};

}  // namespace

Declarations declarations_in(std::string_view text) {
  return Reader(Lexer(text).tokens()).read();
}

}  // namespace touchtrial::house
