// A Python interpreter in which `marey._core` is built in.
#include <Python.h>

extern "C" PyObject* PyInit__core();

int main(int argc, char** argv) {
  PyImport_AppendInittab("marey._core", PyInit__core);
  return Py_BytesMain(argc, argv);
}
