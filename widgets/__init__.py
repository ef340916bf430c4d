"""What is seen and touched: Qt and pyqtgraph."""
