#pragma once

namespace railstep {

/// This program's version and the commit it was built from, "unknown" outside a repository.
const char* version_text();

}  // namespace railstep
