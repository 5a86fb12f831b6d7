# cmake -DBUILD=... -DSOURCE=... -DCOMPILER=... -P test.cmake: installs, builds the consumer against it, runs it;
# builds it with limn as a part, and one program with pkg-config alone.
set(work ${BUILD}/consumer)
file(REMOVE_RECURSE ${work})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${work}/build -G Ninja -DCMAKE_PREFIX_PATH=${work}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${work}/build)
foreach(component silhouette raster scene)
  run(${work}/build/use_${component})
endforeach()
run(${work}/prefix/bin/limn --version)
# As a part of another project: its headers are found. (Building all of limn once more would take a minute.)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${work}/part -G Ninja -DLIMN_SOURCE=${SOURCE}/../.. -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${work}/part --target CMakeFiles/use_silhouette.dir/use_silhouette.cpp.o)
file(GLOB_RECURSE config ${work}/prefix/limn.pc)
get_filename_component(folder ${config} DIRECTORY)
run(sh -c "PKG_CONFIG_PATH=${folder} && export PKG_CONFIG_PATH && \
  ${COMPILER} -std=c++20 ${SOURCE}/use_scene.cpp -o ${work}/by_pkg_config \
  $(pkg-config --define-prefix --cflags --libs --static limn) && ${work}/by_pkg_config")
