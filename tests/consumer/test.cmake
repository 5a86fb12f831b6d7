# cmake -DBUILD=... -DSOURCE=... -DCOMPILER=... -P test.cmake: installs, builds the consumer against it, runs it; and
# builds one program with pkg-config alone.
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
file(GLOB_RECURSE config ${work}/prefix/limn.pc)
get_filename_component(folder ${config} DIRECTORY)
run(sh -c "PKG_CONFIG_PATH=${folder} && export PKG_CONFIG_PATH && \
  ${COMPILER} -std=c++20 ${SOURCE}/use_scene.cpp -o ${work}/by_pkg_config \
  $(pkg-config --define-prefix --cflags --libs --static limn) && ${work}/by_pkg_config")
