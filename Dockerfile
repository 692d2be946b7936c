# Node and live page on ROS 2, as a user without rights and on a root that is read only. Checked by
# hadolint, not yet built.
#
#   docker build -t ballscrew_monitor .
#   docker run --read-only --tmpfs /tmp --tmpfs /run --network host --ipc host \
#     -v ballscrew:/var/lib/ballscrew -v /etc/ballscrew:/etc/ballscrew:ro ballscrew_monitor
#   docker run --read-only --tmpfs /tmp --tmpfs /run --network host --ipc host --no-healthcheck \
#     ballscrew_monitor python3 -m ballscrew_monitor page
#
# The node reads /etc/ballscrew/monitor.yaml. FastDDS keeps shared memory by user: publishers on the
# same machine must run as user 10001 too, or without shared memory.
ARG ROS_DISTRO=jazzy
FROM ros:${ROS_DISTRO}-ros-base AS build
SHELL ["/bin/bash", "-o", "pipefail", "-c"]
WORKDIR /ws
COPY . src/ballscrew_monitor
RUN ln -s ballscrew_monitor/msg_defs src/ballscrew_msgs \
    && apt-get update \
    && rosdep update \
    && rosdep install -y --from-paths src --ignore-src -t buildtool -t build -t exec \
    && source "/opt/ros/$ROS_DISTRO/setup.bash" \
    && colcon build --merge-install --install-base /opt/ballscrew

FROM ros:${ROS_DISTRO}-ros-base
SHELL ["/bin/bash", "-o", "pipefail", "-c"]
COPY package.xml /ws/src/ballscrew_monitor/
COPY msg_defs/package.xml /ws/src/ballscrew_msgs/
# What rosdep does not have: bags, full solves, logs and the page.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends python3-venv \
    && rosdep update \
    && rosdep install -y --from-paths /ws/src --ignore-src -t exec \
    && python3 -m venv --system-site-packages /opt/venv \
    && /opt/venv/bin/pip install --no-cache-dir 'numba>=0.59' 'mcap>=1.1' 'zstandard>=0.20' \
       'lz4>=4.0' 'polars>=1.0' 'fastexcel>=0.12' 'starlette>=0.37' 'uvicorn>=0.40' 'websockets>=14.0' \
       'prometheus-client>=0.20' \
    && rm -rf /var/lib/apt/lists/* /ws/src /root/.ros \
    && useradd --system --uid 10001 --home-dir /run ballscrew \
    && install -d -o ballscrew /var/lib/ballscrew
COPY --from=build /opt/ballscrew /opt/ballscrew
RUN echo 'source /opt/ballscrew/setup.bash; exec "$@"' > /opt/ballscrew/run.bash
# Logs and compiled code go to memory, and what outlives the node to the volume.
ENV PATH=/opt/venv/bin:$PATH ROS_LOG_DIR=/run/log XDG_CACHE_HOME=/run/cache XDG_STATE_HOME=/var/lib/ballscrew
USER 10001
VOLUME /var/lib/ballscrew
STOPSIGNAL SIGINT
# The node beats once a second while its loop runs. For a node of another name, name its topic here.
HEALTHCHECK --interval=30s --timeout=15s --start-period=30s \
    CMD ["bash", "/opt/ballscrew/run.bash", "timeout", "10", "ros2", "topic", "echo", "--once", "--no-daemon", "/ballscrew_monitor/heartbeat", "std_msgs/msg/UInt64"]
ENTRYPOINT ["bash", "/opt/ballscrew/run.bash"]
CMD ["python3", "-m", "ballscrew_monitor.node", "--ros-args", "--params-file", "/etc/ballscrew/monitor.yaml"]
