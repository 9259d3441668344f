//! Nothing: the package is its tests, and the libraries that they load are its examples.
