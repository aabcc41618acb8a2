"""Pictures that several papers share: curves of joints, paths of the tool, descents of swarms."""
