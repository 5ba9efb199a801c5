/// \file Inverses of information matrices: a few parameters, perhaps without information.
#pragma once

#include <optional>
#include <vector>

namespace touchtrial::planning {

/// \param matrix  row-major, symmetric, n x n
/// \return its inverse; nothing if it is not positive definite to about 10 digits
[[nodiscard]] std::optional<std::vector<double>> inverse_of(std::vector<double> matrix,
                                                            std::size_t n);

}  // namespace touchtrial::planning
