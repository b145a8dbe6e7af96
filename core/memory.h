/// How this process gets its memory.
#pragma once

namespace meniscus {

/// Keeps freed memory for the next arrays instead of giving it back page by
/// page: stages allocate and free the same large arrays again and again, and
/// clearing new pages is up to a fifth of a film's time. For programs, at
/// their start; a library leaves the choice to the program. No effect where
/// the C library is not glibc.
void keep_freed_memory();

}  // namespace meniscus
