# SPDX-License-Identifier: MIT
# The service in a container: no X server, no GPU needed, no root.
#
#   docker build -t penumbra .
#   docker run --rm -p 8080:8080 penumbra
#   docker run --rm -p 8080:8080 --read-only --tmpfs /var/cache/penumbra --cap-drop ALL penumbra
#
# Debian 13 for its Mesa: llvmpipe there is several times faster on what the shaders do than Debian 12's.

FROM debian:trixie-slim AS build
WORKDIR /src
# Packages first: they change least, and their layer is kept.
COPY scripts/common.sh scripts/setup scripts/
RUN scripts/setup --build-only
COPY CMakeLists.txt CMakePresets.json ./
COPY cmake cmake
COPY docs/openapi.json docs/scene.schema.json docs/
COPY glsl glsl
COPY core core
COPY server server
RUN cmake --preset release -DPENUMBRA_BUILD_TESTS=OFF \
    && cmake --build --preset release --target penumbra \
    && strip build/release/penumbra

FROM debian:trixie-slim
LABEL org.opencontainers.image.title="penumbra" \
      org.opencontainers.image.description="A headless render service for light in flatland" \
      org.opencontainers.image.licenses="MIT"
# Only what the program needs to run. Lists, logs and manuals are of no use here. (A bind mount instead of the copy would not do: not
# every builder makes the layer anew when what it shows has changed.)
COPY scripts/common.sh scripts/setup /setup/
RUN /setup/setup --run-only \
    && rm -rf /setup /var/lib/apt/lists/* /var/cache/apt/* /var/cache/debconf/* /var/log/* \
        /usr/share/doc/* /usr/share/man/* /usr/share/locale/* \
    && install -d -m 1777 /var/cache/penumbra
COPY LICENSE /usr/share/doc/penumbra/LICENSE
COPY --from=build /src/build/release/penumbra /usr/local/bin/penumbra
# Ends the build when a library is missing.
RUN ["penumbra", "--version"]

# The one path that is written to: compiled shaders, a few hundred KB. Give it a tmpfs when the root is
# read-only; without a writable path each start compiles anew (under a second more).
ENV MESA_SHADER_CACHE_DIR=/var/cache/penumbra \
    MALLOC_ARENA_MAX=2 \
    PENUMBRA_HOST=0.0.0.0
# Any other user id works as well. Options come as arguments or as PENUMBRA_..., which the health check follows.
USER 10001:10001
EXPOSE 8080
HEALTHCHECK --interval=30s --timeout=5s --start-period=30s --retries=3 \
    CMD ["penumbra", "health"]
# It handles its signals and waits for the workers that it starts: it needs no init in front.
ENTRYPOINT ["penumbra"]
CMD ["serve"]
