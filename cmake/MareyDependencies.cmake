# Every library that Marey is built on, found in one place. `script/setup` installs them.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc video calib3d aruco dnn)
find_package(Ceres 2.1 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(TBB REQUIRED)
find_package(Boost 1.74 REQUIRED)  # Asio and Beast, which are headers
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(tomlplusplus 3.3 REQUIRED)
find_package(pugixml 1.13 REQUIRED)
find_package(hwy 1.0 REQUIRED)
find_package(SQLite3 3.40 REQUIRED)
find_package(OpenSSL 3.0 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFMPEG REQUIRED IMPORTED_TARGET libavformat libavcodec libavutil libswscale)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(QRENCODE REQUIRED IMPORTED_TARGET libqrencode)  # codes that phones read from a terminal
pkg_check_modules(ARAVIS IMPORTED_TARGET aravis-0.8)  # machine-vision cameras: may be absent
if(MAREY_TESTS)
  find_package(GTest REQUIRED)
  find_package(OpenCV 4.6 REQUIRED COMPONENTS imgcodecs)  # reads back what was drawn
  # Named, so that another python3 that comes first on PATH is not taken.
  set(Python3_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "The interpreter of the script that tests call")
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
endif()
if(MAREY_BENCH)
  find_package(benchmark REQUIRED)
endif()
