#pragma once

namespace marey {

/// For a std::unique_ptr to what a C library frees through a pointer to its pointer.
template <typename T, void (*Free)(T**)>
struct CDeleter {
  void operator()(T* object) const { Free(&object); }
};

}  // namespace marey
