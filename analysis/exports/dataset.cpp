#include "analysis/exports/dataset.hpp"

#include <algorithm>

namespace touchtrial::analysis {
namespace {

/// Tells whether a character is an ASCII letter or digit, in every locale.
bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

std::string participant_label(const std::string& participant) {
  std::string label;
  for (const char c : participant) {
    if (is_plain(c) && c != 'Z') {
      label += c;
    } else {
      label += 'Z';
      label += c == '-' ? 'd' : c == '_' ? 'u' : c == '+' ? 'p' : 'Z';
    }
  }
  return label;
}

std::string plain_label(const std::string& name) {
  std::string label;
  std::copy_if(name.begin(), name.end(), std::back_inserter(label), is_plain);
  return label.empty() ? "study" : label;
}

}  // namespace touchtrial::analysis
