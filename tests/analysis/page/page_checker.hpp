/// \file Whether a page is whole, needs nothing outside itself, and can be read without seeing it.
#pragma once

#include <string>
#include <vector>

namespace touchtrial {

/// What is wrong with a page, one sentence each; empty: nothing that this checker knows of.
///
/// Elements close in order; ids are unique, and every reference to one leads somewhere; no script,
/// no handler, no address outside the page; the language is named; there is one h1, and headings do
/// not skip a level; tables have a caption and headers with a scope, and as many cells in every
/// row; figures have a caption, and pictures in them words; what scrolls can be reached by
/// keyboard.
[[nodiscard]] std::vector<std::string> faults_of_page(const std::string& html);

}  // namespace touchtrial
