#pragma once

namespace grinder {

/// Finds the shared library's definition of a function that the program overrides. Ends the program if there is none,
/// because the override would have nothing to call.
/// @param symbol mangled name of the function.
void* originalSymbol(const char* symbol);

}  // namespace grinder
