"""Robots as files of other programs: MuJoCo, Gazebo, Drake, MoveIt, ROS 2."""
