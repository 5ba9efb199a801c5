/// \file A database of ours that is no longer whole.
#pragma once

#include "core/errors.hpp"

namespace touchtrial::store {

/// A Touchtrial database that is truncated, lacks tables, or has pages that cannot be read: unlike
/// a name that was mistyped, evidence that does not hold.
class DamagedStore : public StoreError {
 public:
  using StoreError::StoreError;
};

}  // namespace touchtrial::store
